// The action of every task: two poses on the table, 12 numbers.
#pragma once
#include <array>

#include <lgabench/core/geometry.hpp>

namespace lgabench {

/// A position on the table and a rotation. As 6 numbers: x, y, then the quaternion x, y, z, w.
struct PlanarPose {
  Vec2 position_m;
  Quat rotation;
};

/// pick_and_place and rotate: pose0 is where suction takes hold, pose1 where it lets go, turned by pose1's rotation.
/// sweep: the spatula descends at pose0 and pushes straight to pose1. (VIMA's action space; paper, appendix.)
struct Action {
  PlanarPose pose0, pose1;
};

using ActionVector = std::array<float, 12>;

/// pose0 position (2), pose0 rotation (4), pose1 position (2), pose1 rotation (4). Quaternions are written with
/// w >= 0, since q and -q turn alike and a regression target must be unique.
ActionVector to_vector(const Action& action);
Action from_vector(const ActionVector& values);

/// The action that the environment carries out: positions clipped to the workspace, quaternions normalised.
/// @throws MethodError if a number is not finite or a quaternion's norm is below 1e-6.
Action executable(const Action& action);

}  // namespace lgabench
