// How an action is carried out by suction. Needs no engine's own functions; times and speeds are simulated ones.
#pragma once
#include <common/motions.hpp>
#include <tabletop/failures.hpp>
#include <tabletop/two_poses.hpp>

namespace lgabench::tabletop {

/// The suction disc (docs/protocol.md, section 2).
constexpr double suction_radius_m = 0.01;
constexpr double lift_m = 0.1;  // how high a tool goes above what it takes or meets

struct Motion {
  int taken = no_body;                        // the body that suction took, or the first that a tool touched
  bool came_to_rest = true;                   // false: the limit in simulation steps was reached
  Failure failure = lgabench::failure::none;  // what went wrong on the way, whatever the end looks like
};

/// Topmost body under the suction disc at `point`: no_body where the disc covers only table. `height_m` gets the height
/// of the hit.
int under_suction(const PhysicsWorld& world, Vec2 point, double& height_m);

/// Takes the topmost body under the disc at pose0, lifts it by .1 m, carries it to pose1 while turning it by the yaw of
/// pose1's rotation, lowers it until it touches something, lets go and waits until all bodies rest. Takes nothing,
/// and moves nothing, where no body or a fixed one is under the disc. @pre `action` is executable().
Motion pick_and_place(const Bodies& bodies, const TwoPoses& action);

}  // namespace lgabench::tabletop
