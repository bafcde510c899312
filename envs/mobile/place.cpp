#include <mobile/place.hpp>

#include <algorithm>

#include <common/drawing.hpp>

namespace lgabench::mobile {
namespace {

// Solids between two heights, in the world's frame.
struct Builder {
  Furniture made;

  Builder(const std::string& name, Rgb colour) : made{name, {name, {}, 1, true}, {}, colour} {}

  Builder& add(const Polygon& bottom, const Polygon& top, double z_low, double z_high) {
    ConvexPiece piece;
    for (const Vec2 p : bottom) piece.corners_m.push_back({p.x, p.y, z_low});
    for (const Vec2 p : top) piece.corners_m.push_back({p.x, p.y, z_high});
    made.body.pieces.push_back(std::move(piece));
    append(made.mesh, bottom, top, z_low, z_high);
    return *this;
  }
  Builder& add(const Polygon& outline, double z_low, double z_high) { return add(outline, outline, z_low, z_high); }
  Builder& add(const Rectangle& r, double z_low, double z_high) {
    return add(rectangle(r.low.x, r.low.y, r.high.x, r.high.y), z_low, z_high);
  }
};

Furniture make_table() {
  constexpr double thick = .04, leg = .05;
  Builder b("table", {178, 150, 118});
  b.add(table, table_top_m - thick, table_top_m);
  for (const double x : {table.low.x, table.high.x - leg})
    for (const double y : {table.low.y, table.high.y - leg})
      b.add(Rectangle{{x, y}, {x + leg, y + leg}}, 0, table_top_m - thick);
  return b.made;
}

// Stands behind the tray, both hands at it.
Furniture make_person() {
  Builder b("person", {92, 108, 140});
  const auto ellipse = [](Vec2 centre, double half_x, double half_y) {
    Polygon p = disc(1, {}, 12);
    for (Vec2& v : p) v = centre + Vec2{half_x * v.x, half_y * v.y};
    return p;
  };
  for (const double side : {-.09, .09}) b.add(ellipse(person + Vec2{side, 0}, .07, .08), 0, .85);
  b.add(ellipse(person, .17, .11), ellipse(person, .2, .12), .85, 1.4);
  b.add(ellipse(person, .05, .06), 1.4, 1.48);
  b.add(ellipse(person, .08, .1), 1.48, person_height_m);
  for (const double side : {-.17, .17})  // forearms, to the tray's edge
    b.add(rectangle(person.x + side - .03, tray.outer().high.y, person.x + side + .03, person.y), .94, .99);
  return b.made;
}

Furniture make_vessel(const std::string& name, const Vessel& vessel, Rgb colour) {
  Builder b(name, colour);
  const Rectangle outer = vessel.outer();
  const double w = Vessel::wall_m;
  b.add(outer, vessel.underside_m, vessel.floor_m);
  for (const Rectangle& wall :
       {Rectangle{outer.low, {outer.low.x + w, outer.high.y}}, Rectangle{{outer.high.x - w, outer.low.y}, outer.high},
        Rectangle{{outer.low.x + w, outer.low.y}, {outer.high.x - w, outer.low.y + w}},
        Rectangle{{outer.low.x + w, outer.high.y - w}, {outer.high.x - w, outer.high.y}}})
    b.add(wall, vessel.floor_m, vessel.rim_m);
  return b.made;
}

double distance_to_segment(Vec2 p, Vec2 from, Vec2 to) {
  const Vec2 way = to - from;
  const double length2 = way.x * way.x + way.y * way.y;
  const double along = length2 > 0 ? ((p.x - from.x) * way.x + (p.y - from.y) * way.y) / length2 : 0;
  return norm(p - from - std::clamp(along, 0., 1.) * way);
}

double distance_to_segment(const Rectangle& r, Vec2 from, Vec2 to) {
  constexpr double thin = 1e-9;  // a segment as a polygon
  return distance({rectangle(r.low.x, r.low.y, r.high.x, r.high.y)},
                  {convex_hull({from, to, to + Vec2{thin, 0}, to + Vec2{0, thin}})});
}

}  // namespace

const std::vector<Furniture>& furniture() {
  static const std::vector<Furniture> all{make_table(), make_person(), make_vessel("tray", tray, {214, 214, 208}),
                                          make_vessel("bin", bin, {70, 120, 84})};
  return all;
}

bool blocked(Vec2 waypoint) {
  const Vec2 start{};
  return distance_to_segment(table, start, waypoint) < robot_radius_m ||
         distance_to_segment(bin.outer(), start, waypoint) < robot_radius_m ||
         distance_to_segment(person, start, waypoint) < robot_radius_m + person_radius_m;
}

bool meets_person(Vec2 waypoint, Vec2 drop) { return distance_to_segment(person, waypoint, drop) < person_radius_m; }

}  // namespace lgabench::mobile
