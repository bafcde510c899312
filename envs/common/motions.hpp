// Parts of the motions of every environment. They need no engine's own functions; times and speeds are simulated ones.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <lgabench/core/physics_world.hpp>

namespace lgabench::common {

constexpr double lower_speed = 0.5;  // m/s, all the way
constexpr double carry_speed = 3;    // m/s in the middle of the way, see move()
constexpr double turn_speed = 12;    // rad/s, likewise

/// The bodies of a scene, in the order in which they were placed.
struct Bodies {
  PhysicsWorld& world;
  std::vector<bool> fixed;  // cannot be taken
};

/// Counts the steps of one action, of at most 10 s, and calls `after_step` after each. @pre the world outlives it.
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

/// Where the gripper, or another tool, is.
struct Stance {
  Vec3 position_m;
  double yaw_rad = 0;
  Pose pose() const { return {position_m, from_yaw(yaw_rad)}; }
};
using PutTool = std::function<void(const Stance&)>;

/// Straight, the turn at an even share, starting and ending at zero speed (cosine profile); `speed`, in m/s, is the
/// greatest on the way. `put` moves the tool.
/// This and the following @return false where the limit in steps is reached.
bool move(Clock& clock, const Stance& from, const Stance& to, double speed, const PutTool& put);

/// Lets the tool down until `body`, which it holds or is, touches something or the tool is at `floor_m`.
bool lower(PhysicsWorld& world, Clock& clock, Stance& stance, int body, double floor_m, const PutTool& put);

/// Waits until all bodies rest.
bool settle(const Bodies& bodies, Clock& clock);

}  // namespace lgabench::common
