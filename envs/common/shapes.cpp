#include <common/shapes.hpp>

#include <algorithm>
#include <cmath>

namespace lgabench::common {
namespace {

constexpr double thick = 0.036;  // of letters, and of other flat shapes
constexpr double stroke = 0.03;  // of letters: suction needs .01 on either side

Drawing extruded(const std::vector<Polygon>& polygons, double height, Vec2 grasp = {}) {
  Drawing drawing{{}, {}, grasp};
  for (const Polygon& polygon : polygons) drawing.parts.push_back(prism(polygon, 0, height));
  return drawing;
}

Drawing block(double side, double height) {
  return extruded({rectangle(-side / 2, -side / 2, side / 2, side / 2)}, height);
}

// Four bars around a square hole.
std::vector<Polygon> square_band(double side, double width) {
  const double h = side / 2, i = h - width;
  return {rectangle(-h, -h, h, -i), rectangle(-h, i, h, h), rectangle(-h, -i, -i, i), rectangle(i, -i, h, i)};
}

Drawing l_shaped_block() {
  return extruded({rectangle(-.064, -.064, -.014, .064), rectangle(-.014, -.064, .064, -.014)}, .04, {-.036, -.036});
}

// Walls lean outwards. Suction takes hold of the floor.
Drawing bowl() {
  Drawing drawing{{prism(disc(.055), 0, .006)}, {disc(.085)}, {}};
  const auto foot = arc({}, .047, .055, 0, 360, 16), rim = arc({}, .077, .085, 0, 360, 16);
  for (std::size_t i = 0; i < rim.size(); ++i) drawing.parts.push_back({foot[i], rim[i], 0, .06});
  return drawing;
}

Drawing container() {
  Drawing drawing = extruded(square_band(.16, .01), .05);
  drawing.outline = {rectangle(-.08, -.08, .08, .08)};
  drawing.parts.push_back(prism(drawing.outline[0], 0, .008));
  return drawing;
}

Drawing pan() {
  const Vec2 centre{-.04, 0};
  const Polygon handle = rectangle(.034, -.014, .12, .014);
  Drawing drawing = extruded(arc(centre, .072, .08, 0, 360, 16), .03, centre);
  drawing.outline = {disc(.08, centre), handle};
  drawing.parts.push_back(prism(disc(.08, centre), 0, .006));
  drawing.parts.push_back(prism(handle, .016, .03));
  return drawing;
}

// A closed deck, so that nothing small tips into a gap, on three stringers.
Drawing pallet() {
  const Polygon deck = rectangle(-.105, -.0875, .105, .0875);
  Drawing drawing{{prism(deck, .02, .035)}, {deck}, {}};
  for (const double v : {-.0875, -.0125, .0625})
    drawing.parts.push_back(prism(rectangle(-.105, v, .105, v + .025), 0, .02));
  return drawing;
}

Drawing cross() {
  return extruded(
      {rectangle(-.064, -.022, .064, .022), rectangle(-.022, .022, .022, .064), rectangle(-.022, -.064, .022, -.022)},
      thick);
}

Drawing diamond() { return extruded({{{.048, 0}, {0, .064}, {-.048, 0}, {0, -.064}}}, thick); }

Drawing flower() {
  std::vector<Polygon> polygons{disc(.036, {}, 16)};
  for (int petal = 0; petal < 6; ++petal) polygons.push_back(disc(.03, polar({}, .042, 60 * petal), 16));
  return extruded(polygons, thick);
}

// Two lobes, each drawn out to the tip; they overlap in the middle.
Drawing heart() {
  Polygon lobe = disc(.038, {.034, 0});
  lobe.push_back({0, -.09});
  const Polygon right = convex_hull(lobe);
  return extruded({right, mirrored(right)}, thick, {0, -.02});
}

Drawing ring() { return extruded(arc({}, .038, .064, 0, 360, 16), thick, {0, .051}); }

Drawing star() {
  const double tip = .072 / std::sin(72 * pi / 180), notch = .45 * tip;
  std::vector<Polygon> kites;
  for (int i = 0; i < 5; ++i) {
    const double angle = 90 + 72 * i;
    kites.push_back({{}, polar({}, notch, angle - 36), polar({}, tip, angle), polar({}, notch, angle + 36)});
  }
  return extruded(kites, thick);
}

Drawing three_sided_rectangle() {
  return extruded({rectangle(-.1, -.1, .1, -.07), rectangle(-.1, -.07, -.07, .1), rectangle(.07, -.07, .1, .1)}, .03,
                  {0, -.085});
}

Drawing letter_a() {
  const Polygon leg = slanted(-.072, -.072, .072, -.016, .032);
  return extruded({leg, mirrored(leg), rectangle(-.035, -.04, .035, -.012)}, thick, {0, -.026});
}

Drawing letter_e() {
  return extruded({rectangle(-.072, -.072, -.072 + stroke, .072), rectangle(-.042, .042, .072, .072),
                   rectangle(-.042, -.015, .06, .015), rectangle(-.042, -.072, .072, -.042)},
                  thick, {-.02, 0});
}

Drawing letter_g() {
  auto polygons = arc({}, .042, .072, 45, 360, 14);
  polygons.push_back(rectangle(.008, -.026, .066, .004));
  return extruded(polygons, thick, {.025, -.011});
}

Drawing letter_m() {
  const Polygon stem = rectangle(-.072, -.072, -.044, .072), diagonal = slanted(-.036, -.016, .072, -.072, .032);
  return extruded({stem, diagonal, mirrored(diagonal), mirrored(stem)}, thick, {0, -.018});
}

Drawing letter_r() {
  auto polygons = arc({.03, .03}, .014, .042, -90, 90, 6);
  polygons.push_back(rectangle(-.072, -.072, -.042, .072));
  polygons.push_back(rectangle(-.042, .044, .03, .072));
  polygons.push_back(rectangle(-.042, -.012, .03, .016));
  polygons.push_back(slanted(-.072, .04, .002, -.01, .032));
  return extruded(polygons, thick, {-.005, .002});
}

Drawing letter_t() {
  return extruded({rectangle(-.072, .042, .072, .072), rectangle(-.016, -.072, .016, .042)}, thick, {0, .03});
}

Drawing letter_v() {
  const Polygon leg = slanted(-.072, -.018, .072, -.072, .036);
  return extruded({leg, mirrored(leg)}, thick, {0, -.048});
}

}  // namespace

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> all{
      {"L-shaped block", l_shaped_block},
      {"block", [] { return block(.07, .07); }},
      {"bowl", bowl},
      {"container", container},
      {"cross", cross},
      {"diamond", diamond},
      {"flower", flower},
      {"frame",
       [] {
         return extruded(square_band(.225, stroke), .03, {0, -.0975});
       }},
      {"heart", heart},
      {"hexagon", [] { return extruded({regular(6, .072, 0)}, thick); }},
      {"letter A", letter_a},
      {"letter E", letter_e},
      {"letter G", letter_g},
      {"letter M", letter_m},
      {"letter R", letter_r},
      {"letter T", letter_t},
      {"letter V", letter_v},
      {"line", [] { return extruded({rectangle(-.125, -.02, .125, .02)}, .001); }},
      {"pallet", pallet},
      {"pan", pan},
      {"pentagon", [] { return extruded({regular(5, .072 / std::sin(72 * pi / 180), 90)}, thick); }},
      {"ring", ring},
      {"round", [] { return extruded({disc(.064)}, thick); }},
      {"shorter block", [] { return block(.07, .03); }},
      {"small block", [] { return block(.03, .03); }},
      // A painted zone's outline: side .2, border .04, as thin as the line.
      {"square",
       [] {
         return extruded(square_band(.2, .04), .001, {0, -.08});
       }},
      {"star", star},
      {"three-sided rectangle", three_sided_rectangle},
      {"triangle", [] { return extruded({regular(3, .128 / std::sqrt(3.0), 90)}, thick); }},
  };
  return all;
}

}  // namespace lgabench::common
