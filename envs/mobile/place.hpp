// The room: where the robot starts, and what stands in it for good (docs/protocol.md, section 7). z = 0 is the floor.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include <common/light.hpp>
#include <common/objects.hpp>
#include <lgabench/core/geometry.hpp>

namespace lgabench::mobile {

using namespace common;

/// Seen from above, sides along x and y; edges included.
struct Rectangle {
  Vec2 low, high;
  bool contains(Vec2 p) const { return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y; }
  Vec2 centre() const { return .5 * (low + high); }
  /// How far outside a point lies.
  double away(Vec2 p) const { return norm(p - Vec2{std::clamp(p.x, low.x, high.x), std::clamp(p.y, low.y, high.y)}); }
};

/// The robot: a disc on the floor. It starts at the origin and looks along +x.
constexpr double robot_radius_m = .3, robot_height_m = .6;
/// How far from its centre it can set something down, and how far aside of its heading.
constexpr double reach_m = 1.0, reach_aside_rad = pi / 3;
constexpr double carrying_height_m = 1.3;

/// The table's near edge is .6 ahead of the camera.
constexpr Rectangle table{{.6, -.6}, {1.3, .6}};
constexpr double table_top_m = .72;
/// Where objects stand: .46 deep, .8 wide, at the table's centre.
constexpr Rectangle zone{{.72, -.4}, {1.18, .4}};

/// The person is a disc to a robot that drives by.
constexpr Vec2 person{-.3, 2.05};
constexpr double person_radius_m = .25, person_height_m = 1.7;

/// Something open above that things are dropped into: a bottom and four walls, thick enough that nothing passes them in
/// one step of an engine.
struct Vessel {
  Vec2 centre;
  double inner_m;         // side of the square that it holds
  double floor_m, rim_m;  // heights of its bottom's top, and of its walls' tops
  double underside_m;     // of its bottom
  static constexpr double wall_m = .03;
  Rectangle outer() const {
    const Vec2 half{inner_m / 2 + wall_m, inner_m / 2 + wall_m};
    return {centre - half, centre + half};
  }
};
/// Held by the person.
constexpr Vessel tray{{-.3, 1.65}, .22, 1.0, 1.04, .97};
constexpr Vessel bin{{-.45, -1.5}, .29, .03, .5, 0};

/// One of the four things that never move: in every scene, placed before its objects.
struct Furniture {
  std::string name;
  BodyModel body;  // in the world's frame
  Mesh mesh;
  Rgb colour;
};
/// Table, person, tray, bin.
const std::vector<Furniture>& furniture();

/// The robot cannot drive straight from where it starts to `waypoint`: it would meet the table, the bin or the person.
bool blocked(Vec2 waypoint);
/// What the arm carries from above the waypoint to above the drop meets the person, who alone is that tall.
bool meets_person(Vec2 waypoint, Vec2 drop);

}  // namespace lgabench::mobile
