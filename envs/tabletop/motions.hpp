// What motions are made of: what an action does to the bodies. Engine-free; times and speeds are simulated ones.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <lgabench/core/physics_world.hpp>
#include <tabletop/failures.hpp>
#include <tabletop/two_poses.hpp>

namespace lgabench::tabletop {

/// The suction disc (docs/protocol.md, section 2).
constexpr double suction_radius_m = 0.01;
constexpr double lift_m = 0.1;       // how high a tool goes above what it takes or meets
constexpr double lower_speed = 0.5;  // m/s
constexpr double carry_speed = 3;    // greatest ones: m/s,
constexpr double turn_speed = 12;    // rad/s

/// The bodies of a scene, in the order in which they were placed.
struct Bodies {
  PhysicsWorld& world;
  std::vector<bool> fixed;  // cannot be taken
};

struct Motion {
  int taken = no_body;                        // the body that suction took, or the first that a tool touched
  bool came_to_rest = true;                   // false: the limit in simulation steps was reached
  Failure failure = lgabench::failure::none;  // what went wrong on the way, whatever the end looks like
};

/// Counts the steps of one action, and calls `after_step` after each.
class Clock {
 public:
  explicit Clock(PhysicsWorld& world, std::function<void()> after_step = {});

  /// @return false, and no step, once the limit is reached.
  bool step();
  int steps(double seconds) const { return std::max(1, static_cast<int>(std::ceil(seconds / world_.time_step_s()))); }

 private:
  PhysicsWorld& world_;
  std::function<void()> after_step_;
  int left_;
};

/// Of the gripper, or of another tool.
struct Stance {
  Vec3 position_m;
  double yaw_rad = 0;
  Pose pose() const { return {position_m, from_yaw(yaw_rad)}; }
};
using PutTool = std::function<void(const Stance&)>;

/// Straight, the turn at an even share, starting and ending at zero speed (cosine profile). `put` moves the tool.
/// This and the following @return false where the limit in steps is reached.
bool move(Clock& clock, const Stance& from, const Stance& to, double speed, const PutTool& put);

/// Lets the tool down until `body`, which it holds or is, touches something or the tool is at `floor_m`.
bool lower(PhysicsWorld& world, Clock& clock, Stance& stance, int body, double floor_m, const PutTool& put);

/// Waits until all bodies rest.
bool settle(const Bodies& bodies, Clock& clock);

/// Topmost body under the suction disc at `point`: no_body where the disc covers only table. `height_m` gets the height
/// of the hit.
int under_suction(const PhysicsWorld& world, Vec2 point, double& height_m);

/// Takes the topmost body under the disc at pose0, lifts it by .1 m, carries it to pose1 while turning it by the yaw of
/// pose1's rotation, lowers it until it touches something, lets go and waits until all bodies rest. Takes nothing,
/// and moves nothing, where no body or a fixed one is under the disc. @pre `action` is executable().
Motion pick_and_place(const Bodies& bodies, const TwoPoses& action);

}  // namespace lgabench::tabletop
