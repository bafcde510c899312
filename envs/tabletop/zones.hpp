// Sweep's goal: two strips painted on the table, |y| in [.34, .48], over its whole depth (docs/protocol.md, section 3).
#pragma once
#include <cmath>

#include <lgabench/core/geometry.hpp>

namespace lgabench::tabletop {

struct GoalZones {
  static constexpr double near_m = 0.34, far_m = 0.48;
  static bool contains(Vec2 p) { return std::abs(p.y) >= near_m && std::abs(p.y) <= far_m; }
};

}  // namespace lgabench::tabletop
