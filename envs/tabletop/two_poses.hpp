// The action of every task: two poses on the table, 12 numbers.
#pragma once
#include <string>

#include <lgabench/core/action.hpp>
#include <tabletop/workspace.hpp>

namespace lgabench::tabletop {

/// A position on the table and a rotation. As 6 numbers: x, y, then the quaternion x, y, z, w.
struct PlanarPose {
  Vec2 position_m;
  Quat rotation;
};

/// pick_and_place and rotate: pose0 is where suction takes hold, pose1 where it lets go, turned by pose1's rotation.
/// sweep: the spatula descends at pose0 and pushes straight to pose1. (VIMA's action space; paper, appendix.)
struct TwoPoses {
  PlanarPose pose0{}, pose1{};

  TwoPoses() = default;
  TwoPoses(const PlanarPose& first, const PlanarPose& second) : pose0(first), pose1(second) {}
  /// @pre 12 numbers
  TwoPoses(const Action& a)
      : pose0{{a[0], a[1]}, {a[2], a[3], a[4], a[5]}}, pose1{{a[6], a[7]}, {a[8], a[9], a[10], a[11]}} {}
  operator Action() const {
    const auto& [p, p_turned] = pose0;
    const auto& [q, q_turned] = pose1;
    return {p.x, p.y, p_turned.x, p_turned.y, p_turned.z, p_turned.w,
            q.x, q.y, q_turned.x, q_turned.y, q_turned.z, q_turned.w};
  }
};

/// TwoPoses as numbers: pose0.x to pose1.qw.
inline const ActionSpace& two_poses() {
  static const ActionSpace space = [] {
    ActionSpace s;
    for (const std::string pose : {"pose0", "pose1"}) {
      const std::size_t x = s.size(), q = x + 2;
      s.numbers.push_back({pose + ".x", "m", Workspace::x_min, Workspace::x_max});
      s.numbers.push_back({pose + ".y", "m", Workspace::y_min, Workspace::y_max});
      for (const char* part : {".qx", ".qy", ".qz", ".qw"}) s.numbers.push_back({pose + part, "", -1, 1});
      s.places.push_back({x, x + 1});
      s.rotations.push_back({q, q + 1, q + 2, q + 3});
    }
    return s;
  }();
  return space;
}

}  // namespace lgabench::tabletop
