// The motions of the tabletop: what an action does to the bodies. Engine-free; times and speeds are simulated ones.
#pragma once
#include <vector>

#include <lgabench/core/action.hpp>
#include <lgabench/core/physics_world.hpp>

namespace lgabench::tabletop {

/// The suction disc (PROTOCOL, section 2).
constexpr double suction_radius_m = 0.01;

/// The bodies of a scene, in the order in which they were placed.
struct Bodies {
  PhysicsWorld& world;
  std::vector<bool> fixed;  // cannot be taken
};

struct Motion {
  int taken = no_body;       // the body that suction took
  bool came_to_rest = true;  // false: the limit in simulation steps was reached
};

/// Topmost body under the suction disc at `point`: no_body where the disc covers only table. `height_m` gets the height
/// of the hit.
int under_suction(const PhysicsWorld& world, Vec2 point, double& height_m);

/// Takes the topmost body under the disc at pose0, lifts it by .1 m, carries it to pose1 while turning it by the yaw of
/// pose1's rotation, lowers it until it touches something, lets go and waits until all bodies rest. Takes nothing,
/// and moves nothing, where no body or a fixed one is under the disc. @pre `action` is executable.
Motion pick_and_place(const Bodies& bodies, const Action& action);

}  // namespace lgabench::tabletop
