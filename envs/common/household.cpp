// The household types. What is round underneath in life is flat here, so that it stays where it is put; what is tall
// lies on its side, as a view from above shows it best.
#include <algorithm>

#include <common/shapes.hpp>

namespace lgabench::common {
namespace {

// Rounded by `round` above, by less below.
std::vector<Level> soft(double height, double round) {
  return {{0, .6 * round}, {.4 * height, 0}, {.8 * height, .4 * round}, {height, round}};
}

std::vector<Level> bevelled(double height, double bevel) { return {{0, 0}, {height - bevel, 0}, {height, bevel}}; }

std::vector<Level> slab(double low, double high) { return {{low, 0}, {high, 0}}; }

Polygon capsule(double radius, Vec2 centre, double other_radius, Vec2 other_centre) {
  Polygon both = disc(radius, centre);
  for (const Vec2 p : disc(other_radius, other_centre)) both.push_back(p);
  return convex_hull(both);
}

Polygon ellipse(double half_length, double half_width, Vec2 centre = {}) {
  Polygon polygon = disc(1, {}, 24);
  for (Vec2& p : polygon) p = centre + Vec2{half_length * p.x, half_width * p.y};
  return polygon;
}

// A pointed leaf from a stem outwards.
Polygon leaf(Vec2 stem, double length, double width, double degrees) {
  const auto at = [&](double along, double aside) {
    return polar(polar(stem, along * length, degrees), aside * width, degrees + 90);
  };
  return {at(0, -.1), at(.3, -.45), at(.65, -.4), at(1, -.05), at(1, .05), at(.65, .4), at(.3, .45), at(0, .1)};
}

// A stretch of something turned, lying along u: a circle of radius r0 to r1, flattened above and below.
void add_lying(Drawing& drawing, double axis_z, double u0, double u1, double r0, double r1) {
  const double r = std::max(r0, r1), thinnest = std::min(r0, r1);
  const auto section = [&](double inwards) {
    return Polygon{{u0, inwards - r0}, {u1, inwards - r1}, {u1, r1 - inwards}, {u0, r0 - inwards}};
  };
  const Polygon widest = section(0), higher = section(.2 * thinnest), flat = section(.56 * thinnest);
  drawing.outline.push_back(widest);
  drawing.parts.push_back({flat, widest, axis_z - .9 * r, axis_z});
  drawing.parts.push_back({widest, higher, axis_z, axis_z + .6 * r});
  drawing.parts.push_back({higher, flat, axis_z + .6 * r, axis_z + .9 * r});
}

// On its side, so that stalk, leaf and the hollow between the two lobes show.
Drawing apple() {
  Drawing drawing{{}, {}, {0, .003}};
  const Polygon right = capsule(.032, {.014, .006}, .02, {.01, -.026});
  for (const Polygon& lobe : {right, mirrored(right)}) add_solid(drawing, lobe, soft(.055, .013));
  add_solid(drawing, slanted(.024, -.005, .056, .004, .008), slab(.024, .036));
  add_solid(drawing, leaf({.006, .042}, .036, .022, 12), slab(.034, .042));
  return drawing;
}

Drawing tomato() {
  Drawing drawing;
  add_solid(drawing, disc(.043), {{0, .014}, {.022, 0}, {.042, .009}, {.054, .026}});
  for (int i = 0; i < 5; ++i) {  // the calyx
    const double angle = 90 + 72 * i;
    drawing.parts.push_back(
        prism({{}, polar({}, .013, angle - 36), polar({}, .037, angle), polar({}, .013, angle + 36)}, .04, .06));
  }
  return drawing;
}

Drawing banana() {
  Drawing drawing{{}, {}, {0, -.07}};
  const double from = 213, to = 327, inner = .053, outer = .087;
  const std::vector<Level> levels = soft(.032, .0065);
  drawing.outline = arc({}, inner, outer, from, to, 5);
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
    const auto section = [&](Level level) { return arc({}, inner + level.inset, outer - level.inset, from, to, 5); };
    const auto low = section(levels[i]), high = section(levels[i + 1]);
    for (std::size_t j = 0; j < low.size(); ++j)
      drawing.parts.push_back({low[j], high[j], levels[i].z, levels[i + 1].z});
  }
  add_solid(drawing,
            {polar({}, .054, to - 5), polar({}, .086, to - 5), polar({}, .069, to + 16), polar({}, .061, to + 16)},
            slab(.008, .024));
  add_solid(
      drawing,
      {polar({}, .067, from - 8), polar({}, .075, from - 8), polar({}, .086, from + 4), polar({}, .054, from + 4)},
      slab(.008, .024));
  return drawing;
}

// Cut in half, the cut upwards: eight segments in a rind.
Drawing orange() {
  Drawing drawing;
  add_solid(drawing, disc(.046), {{0, .02}, {.036, 0}});
  for (int i = 0; i < 8; ++i) {
    const double angle = 22.5 + 45 * i;
    const Polygon segment{polar({}, .017, angle - 14), polar({}, .036, angle - 18), polar({}, .039, angle),
                          polar({}, .036, angle + 18), polar({}, .017, angle + 14)};
    drawing.parts.push_back({segment, inset(segment, .003), .034, .042});
  }
  return drawing;
}

Drawing lemon() {
  Drawing drawing;
  add_solid(drawing, ellipse(.042, .031), soft(.048, .016));
  const Polygon nipple{{.03, -.016}, {.052, -.006}, {.052, .006}, {.03, .016}};
  for (const Polygon& end : {nipple, mirrored(nipple)}) add_solid(drawing, end, {{.012, 0}, {.026, 0}, {.032, .004}});
  return drawing;
}

Drawing pear() {
  Drawing drawing{{}, {}, {0, -.02}};
  add_solid(drawing, disc(.039, {0, -.022}), soft(.05, .013));
  add_solid(drawing, capsule(.021, {0, .034}, .03, {0, -.016}), soft(.05, .013));
  add_solid(drawing, slanted(.048, -.004, .078, .006, .007), slab(.018, .028));
  return drawing;
}

Drawing carrot() {
  Drawing drawing{{}, {}, {.02, 0}};
  add_solid(drawing, capsule(.019, {.022, 0}, .0055, {-.074, 0}), soft(.03, .005));
  for (const double degrees : {-30, 0, 30}) add_solid(drawing, leaf({.034, 0}, .046, .016, degrees), slab(.008, .018));
  return drawing;
}

// A slice.
Drawing bread() {
  Drawing drawing;
  const Polygon lobe = disc(.029, {.033, .031});
  for (const Polygon& part : {rectangle(-.05, -.06, .05, .032), rectangle(-.036, 0, .036, .053), lobe, mirrored(lobe)})
    add_solid(drawing, part, bevelled(.022, .006));
  return drawing;
}

// Along u, its end at -.09; the other end's half width is given. Thin, so that fork and spoon do not sag when suction
// holds them by the head.
void add_handle(Drawing& drawing, double u, double half_width) {
  add_solid(drawing, {{-.09, -.007}, {u, -half_width}, {u, half_width}, {-.09, .007}}, bevelled(.005, .001));
}

Drawing fork() {
  Drawing drawing{{}, {}, {.038, 0}};
  add_handle(drawing, .02, .005);
  add_solid(drawing, {{.01, -.005}, {.028, -.015}, {.05, -.015}, {.05, .015}, {.028, .015}, {.01, .005}}, slab(0, .01));
  for (const double v : {-.015, -.003, .009}) add_solid(drawing, rectangle(.05, v, .09, v + .006), slab(0, .01));
  return drawing;
}

Drawing spoon() {
  Drawing drawing{{}, {}, {.042, 0}};
  add_handle(drawing, .03, .006);
  add_solid(drawing, ellipse(.036, .015, {.054, 0}), bevelled(.01, .003));
  return drawing;
}

Drawing knife() {
  Drawing drawing{{}, {}, {0, -.001}};
  add_solid(drawing, capsule(.01, {-.07, .002}, .0085, {-.022, .002}), bevelled(.014, .004));
  add_solid(drawing, {{-.02, -.016}, {.035, -.016}, {.062, -.007}, {.08, .012}, {-.02, .012}}, bevelled(.006, .002));
  return drawing;
}

Drawing mug() {
  Drawing drawing{{prism(disc(.036, {}, 24), 0, .01)}, {disc(.043, {}, 24), rectangle(.04, -.007, .078, .007)}, {}};
  for (const Polygon& wall : arc({}, .036, .043, 0, 360, 12)) drawing.parts.push_back(prism(wall, 0, .085));
  drawing.parts.push_back(prism(rectangle(.04, -.007, .078, .007), .073, .085));
  drawing.parts.push_back(prism(rectangle(.066, -.007, .078, .007), .026, .073));
  drawing.parts.push_back(prism(rectangle(.04, -.007, .078, .007), .014, .026));
  return drawing;
}

Drawing plate() {
  Drawing drawing{{prism(disc(.05), 0, .006)}, {disc(.08)}, {}};
  const auto foot = arc({}, .046, .052, 0, 360, 16), rim = arc({}, .074, .08, 0, 360, 16);
  for (std::size_t i = 0; i < rim.size(); ++i) drawing.parts.push_back({foot[i], rim[i], 0, .02});
  return drawing;
}

Drawing soda_can() {
  Drawing drawing;
  const double axis = .9 * .033;
  add_lying(drawing, axis, -.061, -.053, .025, .033);
  add_lying(drawing, axis, -.053, .037, .033, .033);
  add_lying(drawing, axis, .037, .053, .033, .022);
  add_lying(drawing, axis, .053, .061, .026, .026);
  return drawing;
}

Drawing water_bottle() {
  Drawing drawing{{}, {}, {-.048, 0}};
  const double axis = .9 * .03;
  add_lying(drawing, axis, -.08, -.018, .03, .03);
  add_lying(drawing, axis, -.018, -.008, .026, .026);
  add_lying(drawing, axis, -.008, .022, .03, .03);
  add_lying(drawing, axis, .022, .052, .03, .011);
  add_lying(drawing, axis, .052, .062, .01, .01);
  add_lying(drawing, axis, .062, .08, .014, .014);
  return drawing;
}

Drawing juice_box() {
  Drawing drawing{{}, {}, {-.01, 0}};
  add_solid(drawing, rectangle(-.06, -.034, .04, .034), bevelled(.04, .004));
  add_solid(drawing, rectangle(.038, .008, .064, .017), slab(.016, .025));
  add_solid(drawing, {{.055, .013}, {.064, .008}, {.08, .034}, {.072, .038}}, slab(.016, .025));
  return drawing;
}

// A paintbrush.
Drawing brush() {
  Drawing drawing{{}, {}, {.005, 0}};
  add_solid(drawing, capsule(.008, {-.072, 0}, .011, {-.025, 0}), bevelled(.018, .005));
  add_solid(drawing, {{-.025, -.012}, {-.008, -.027}, {.02, -.027}, {.02, .027}, {-.008, .027}, {-.025, .012}},
            bevelled(.024, .004));
  for (int i = 0; i < 5; ++i) {  // bristles: side by side at the root, apart at the ends
    const double root = -.027 + .0108 * i, tip = -.031 + .0124 * i, end = i % 2 ? .076 : .08;
    add_solid(drawing, {{.018, root}, {end, tip + .001}, {end, tip + .0115}, {.018, root + .0108}}, slab(0, .014));
  }
  return drawing;
}

Drawing drill() {
  Drawing drawing{{}, {}, {-.02, .042}};
  add_solid(drawing, rectangle(-.075, .02, .02, .066), bevelled(.045, .008));
  add_solid(drawing, {{.018, .022}, {.05, .033}, {.05, .053}, {.018, .064}}, {{.008, 0}, {.03, 0}, {.036, .006}});
  add_solid(drawing, rectangle(.045, .039, .085, .047), slab(.016, .024));
  add_solid(drawing, slanted(-.05, -.072, .03, -.05, .032), bevelled(.036, .006));
  add_solid(drawing, rectangle(-.075, -.074, -.015, -.046), bevelled(.045, .006));
  add_solid(drawing, rectangle(-.028, .002, -.014, .022), slab(.012, .024));
  return drawing;
}

Drawing hammer() {
  Drawing drawing{{}, {}, {.058, 0}};
  add_solid(drawing, capsule(.011, {-.069, 0}, .008, {.05, 0}), bevelled(.02, .004));
  add_solid(drawing, rectangle(.042, -.018, .074, .018), bevelled(.028, .004));
  add_solid(drawing, rectangle(.047, -.036, .069, -.016), slab(.003, .024));
  add_solid(drawing, rectangle(.04, -.05, .076, -.034), bevelled(.03, .003));
  add_solid(drawing, {{.046, .016}, {.074, .016}, {.068, .036}, {.048, .032}}, slab(.003, .022));  // the claw
  add_solid(drawing, {{.05, .03}, {.068, .036}, {.05, .054}, {.036, .058}}, slab(.003, .022));
  return drawing;
}

// Pores: between solid strips, strips with two gaps each, at changing places.
Drawing sponge() {
  Drawing drawing;
  const double half = .036, low = .016, high = .032;
  add_solid(drawing, rectangle(-.058, -half, .058, half), {{0, 0}, {low, 0}});
  const auto strip = [&](double left, double right, const std::vector<double>& pores) {
    double from = -half;
    for (const double pore : pores) {
      drawing.parts.push_back(prism(rectangle(left, from, right, pore), low, high));
      from = pore + .012;
    }
    drawing.parts.push_back(prism(rectangle(left, from, right, half), low, high));
  };
  strip(-.058, -.05, {});
  strip(-.05, -.036, {-.022, .01});
  strip(-.036, -.032, {});
  strip(-.032, -.018, {-.008, .018});
  strip(-.018, .018, {});
  strip(.018, .032, {-.026, .006});
  strip(.032, .037, {});
  strip(.037, .05, {-.012, .016});
  strip(.05, .058, {});
  return drawing;
}

}  // namespace

const std::vector<Shape>& household_shapes() {
  static const std::vector<Shape> all{
      {"apple", apple},         {"tomato", tomato},     {"banana", banana},
      {"orange", orange},       {"lemon", lemon},       {"pear", pear},
      {"carrot", carrot},       {"bread", bread},       {"fork", fork},
      {"spoon", spoon},         {"knife", knife},       {"mug", mug},
      {"plate", plate},         {"soda can", soda_can}, {"water bottle", water_bottle},
      {"juice box", juice_box}, {"brush", brush},       {"drill", drill},
      {"hammer", hammer},       {"sponge", sponge},
  };
  return all;
}

}  // namespace lgabench::common
