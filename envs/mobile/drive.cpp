#include <mobile/drive.hpp>

#include <cmath>

namespace lgabench::mobile {
namespace {

constexpr double above_rim_m = .05, slowly_m = .03;

}  // namespace

bool within_reach(const Plan& plan) {
  const Vec2 way = plan.drop_m - plan.waypoint_m;
  const double ahead = way.x * plan.cosine + way.y * plan.sine;
  return norm(way) <= reach_m && ahead >= std::cos(reach_aside_rad) * norm(way);
}

bool carry(const Bodies& bodies, int body, Vec3 grasp, const Plan& plan, const Vessel& goal) {
  PhysicsWorld& world = bodies.world;
  Clock clock(world);
  const double hangs_m = grasp.z - world.pose(body).position_m.z;  // below the gripper
  const auto high = [](Vec2 p, double yaw) { return Stance{{p.x, p.y, carrying_height_m}, yaw}; };
  const double heading = std::atan2(plan.sine, plan.cosine), release_m = goal.rim_m + above_rim_m + hangs_m;
  const Stance at{grasp, 0}, up = high({grasp.x, grasp.y}, 0), home = high({}, 0),
                             there = high(plan.waypoint_m, heading), over = high(plan.drop_m, heading);
  Stance low = over;
  low.position_m.z = std::min(release_m + slowly_m, carrying_height_m);
  const auto put = [&](const Stance& stance) { world.move_gripper(stance.pose()); };
  const auto go = [&](const Stance& from, const Stance& to) { return move(clock, from, to, carry_speed, put); };

  world.grip(body, at.pose());
  const bool dropped = go(at, up) && go(up, home) && go(home, there) && go(there, over) && go(over, low) &&
                       lower(world, clock, low, body, release_m, put);
  world.release();
  return dropped && settle(bodies, clock);
}

}  // namespace lgabench::mobile
