// The motions of the tabletop: what an action does to the bodies. Engine-free; times and speeds are simulated ones.
#pragma once
#include <functional>
#include <vector>

#include <lgabench/core/action.hpp>
#include <lgabench/core/physics_world.hpp>
#include <tabletop/outline.hpp>

namespace lgabench::tabletop {

/// The suction disc (docs/protocol.md, section 2).
constexpr double suction_radius_m = 0.01;
/// Along the blade, through it, upright. The width: docs/protocol.md, section 2.
constexpr Vec3 spatula_size_m{0.12, 0.01, 0.05};

/// The bodies of a scene, in the order in which they were placed.
struct Bodies {
  PhysicsWorld& world;
  std::vector<bool> fixed;  // cannot be taken
};

struct Motion {
  int taken = no_body;            // the body that suction took, or the first that the spatula touched
  bool came_to_rest = true;       // false: the limit in simulation steps was reached
  bool touched_obstacle = false;  // sweep: by target or spatula, at any step
};

/// Topmost body under the suction disc at `point`: no_body where the disc covers only table. `height_m` gets the height
/// of the hit.
int under_suction(const PhysicsWorld& world, Vec2 point, double& height_m);

/// Takes the topmost body under the disc at pose0, lifts it by .1 m, carries it to pose1 while turning it by the yaw of
/// pose1's rotation, lowers it until it touches something, lets go and waits until all bodies rest. Takes nothing,
/// and moves nothing, where no body or a fixed one is under the disc. @pre `action` is executable.
Motion pick_and_place(const Bodies& bodies, const Action& action);

/// Called after each step with the spatula's outline, empty once it is gone.
using Watch = std::function<void(const std::vector<Polygon>& spatula)>;

/// The spatula descends at pose0, its blade across the way to pose1, until it stands on the table or meets a body; is
/// pushed straight to pose1 and taken away; then waits until all bodies rest. The action's rotations do not count.
/// @pre `action` is executable.
Motion sweep(const Bodies& bodies, const Action& action, const Watch& watch);

}  // namespace lgabench::tabletop
