#include <common/motions.hpp>

namespace lgabench::common {
namespace {

constexpr double limit_s = 10;  // of an action, until all is at rest
// At rest: for so long within so much of one pose. (Velocities say less: a body stands still at the top of a throw.)
struct Stillness {
  double for_s, move_m, turn_rad;
};
constexpr Stillness stillness[] = {
    {0.05, 25e-6, 4.4e-4},  // a resting polygon trembles by some 1e-5 m as engines choose among its corners anew
    {0.5, 5e-4, 17e-3},     // what leans on an edge may tremble by half a degree and creep by .05 mm/s for ever
};

bool touches(const PhysicsWorld& world, int body) {
  const auto contacts = world.contacts();
  return std::any_of(contacts.begin(), contacts.end(), [body](Contact c) { return c.a == body || c.b == body; });
}

std::vector<Pose> poses_of(const Bodies& bodies) {
  std::vector<Pose> all;
  for (std::size_t i = 0; i < bodies.fixed.size(); ++i) all.push_back(bodies.world.pose(static_cast<int>(i)));
  return all;
}

bool within(const Stillness& limit, const Pose& a, const Pose& b) {
  const Vec3 way = a.position_m - b.position_m;
  const Quat turn = Quat{-a.rotation.x, -a.rotation.y, -a.rotation.z, a.rotation.w} * b.rotation;
  const auto length = [](double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); };
  return length(way.x, way.y, way.z) < limit.move_m && 2 * length(turn.x, turn.y, turn.z) < limit.turn_rad;
}

}  // namespace

Clock::Clock(PhysicsWorld& world, std::function<void()> after_step)
    : world_(world), after_step_(std::move(after_step)), left_(static_cast<int>(limit_s / world.time_step_s())) {}

bool Clock::step() {
  if (left_ == 0) return false;
  --left_;
  world_.step();
  if (after_step_) after_step_();
  return true;
}

bool move(Clock& clock, const Stance& from, const Stance& to, double speed, const PutTool& put) {
  const Vec3 way = to.position_m - from.position_m;
  const double length = std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z), turn = to.yaw_rad - from.yaw_rad;
  const double mean_to_peak = pi / 2;
  const int n = clock.steps(mean_to_peak * std::max(length / speed, std::abs(turn) / turn_speed));
  for (int i = 1; i <= n; ++i) {
    const double share = (1 - std::cos(pi * i / n)) / 2;
    put(Stance{from.position_m + share * way, from.yaw_rad + share * turn});
    if (!clock.step()) return false;
  }
  return true;
}

bool lower(PhysicsWorld& world, Clock& clock, Stance& stance, int body, double floor_m, const PutTool& put) {
  const double step_m = lower_speed * world.time_step_s();
  while (stance.position_m.z > floor_m && !touches(world, body)) {
    stance.position_m.z = std::max(stance.position_m.z - step_m, floor_m);
    put(stance);
    if (!clock.step()) return false;
  }
  return true;
}

bool settle(const Bodies& bodies, Clock& clock) {
  struct Watch {
    Stillness limit;
    std::vector<Pose> anchor;
    int resting = 0;  // steps
  };
  std::vector<Watch> watches;
  for (const Stillness& limit : stillness) watches.push_back({limit, poses_of(bodies)});
  while (clock.step()) {
    const std::vector<Pose> now = poses_of(bodies);
    for (Watch& watch : watches) {
      const auto still = [&watch](const Pose& a, const Pose& b) { return within(watch.limit, a, b); };
      const bool rests = std::equal(now.begin(), now.end(), watch.anchor.begin(), still);
      if (!rests) watch.anchor = now;
      watch.resting = rests ? watch.resting + 1 : 1;
      if (watch.resting >= clock.steps(watch.limit.for_s)) return true;
    }
  }
  return false;
}

}  // namespace lgabench::common
