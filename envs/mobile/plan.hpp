// The action: one plan an episode, 8 numbers.
#pragma once
#include <lgabench/core/action.hpp>

namespace lgabench::mobile {

/// Where to take hold in the picture, where to drive and how to stand there, where to drop.
struct Plan {
  double u = 0, v = 0;  // of the picture's width from its left, of its height from its top
  Vec2 waypoint_m;
  double cosine = 1, sine = 0;  // of the heading there, from +x
  Vec2 drop_m;

  Plan() = default;
  /// @pre 8 numbers
  Plan(const Action& a) : u(a[0]), v(a[1]), waypoint_m{a[2], a[3]}, cosine(a[4]), sine(a[5]), drop_m{a[6], a[7]} {}
  operator Action() const { return {u, v, waypoint_m.x, waypoint_m.y, cosine, sine, drop_m.x, drop_m.y}; }
};

/// Plan as numbers. Places in the world are within 3 m of where the robot starts.
inline const ActionSpace& plans() {
  static const ActionSpace space{{{"grasp.u", "", 0, 1},
                                  {"grasp.v", "", 0, 1},
                                  {"waypoint.x", "m", -3, 3},
                                  {"waypoint.y", "m", -3, 3},
                                  {"waypoint.cos", "", -1, 1},
                                  {"waypoint.sin", "", -1, 1},
                                  {"drop.x", "m", -3, 3},
                                  {"drop.y", "m", -3, 3}},
                                 {{4, 5}},
                                 {{1, 0}}};
  return space;
}

}  // namespace lgabench::mobile
