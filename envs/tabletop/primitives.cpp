#include <tabletop/primitives.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lgabench::tabletop {
namespace {

constexpr double lift_m = 0.1;
constexpr double carry_speed = 3, lower_speed = 0.5, turn_speed = 12;  // greatest ones: m/s, m/s, rad/s
constexpr double push_speed = 0.25;                                    // m/s
constexpr double spatula_gap_m = 5e-4;  // to the table, which it need not scrape: less than the thinnest body
constexpr double limit_s = 10;          // of an action, until all is at rest
// At rest: for so long within so much of one pose. (Velocities say less: a body stands still at the top of a throw.)
struct Stillness {
  double for_s, move_m, turn_rad;
};
constexpr Stillness stillness[] = {
    {0.05, 25e-6, 4.4e-4},  // a resting polygon trembles by some 1e-5 m as engines choose among its corners anew
    {0.5, 5e-4, 17e-3},     // what leans on an edge may tremble by half a degree and creep by .05 mm/s for ever
};

/// Counts the steps of one action, and calls `after_step` after each.
class Clock {
 public:
  explicit Clock(PhysicsWorld& world, std::function<void()> after_step = {})
      : world_(world), after_step_(std::move(after_step)), left_(static_cast<int>(limit_s / world.time_step_s())) {}

  /// @return false, and no step, once the limit is reached.
  bool step() {
    if (left_ == 0) return false;
    --left_;
    world_.step();
    if (after_step_) after_step_();
    return true;
  }

  int steps(double seconds) const { return std::max(1, static_cast<int>(std::ceil(seconds / world_.time_step_s()))); }

 private:
  PhysicsWorld& world_;
  std::function<void()> after_step_;
  int left_;
};

/// Of the gripper, or of the spatula.
struct Stance {
  Vec3 position_m;
  double yaw_rad = 0;
  Pose pose() const { return {position_m, from_yaw(yaw_rad)}; }
};

/// Straight, the turn at an even share, starting and ending at zero speed (cosine profile). `put` moves the tool.
template <typename Put>
bool move(Clock& clock, const Stance& from, const Stance& to, double speed, const Put& put) {
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

bool touches(const PhysicsWorld& world, int body) {
  const auto contacts = world.contacts();
  return std::any_of(contacts.begin(), contacts.end(), [body](Contact c) { return c.a == body || c.b == body; });
}

/// A body that the spatula touches: no_body if none.
int under_spatula(const PhysicsWorld& world) {
  for (const Contact c : world.contacts())
    if (std::min(c.a, c.b) == spatula_body && std::max(c.a, c.b) >= 0) return std::max(c.a, c.b);
  return no_body;
}

/// Lets the tool down until `body`, which it holds or is, touches something or the tool is at `floor_m`.
template <typename Put>
bool lower(PhysicsWorld& world, Clock& clock, Stance& stance, int body, double floor_m, const Put& put) {
  const double step_m = lower_speed * world.time_step_s();
  while (stance.position_m.z > floor_m && !touches(world, body)) {
    stance.position_m.z = std::max(stance.position_m.z - step_m, floor_m);
    put(stance);
    if (!clock.step()) return false;
  }
  return true;
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

}  // namespace

int under_suction(const PhysicsWorld& world, Vec2 point, double& height_m) {
  constexpr int ring = 8;
  int body = world.cast_down(point, height_m);
  for (int i = 0; i < ring; ++i) {
    double height = 0;
    const int hit = world.cast_down(point + rotated({suction_radius_m, 0}, 2 * pi * i / ring), height);
    if (hit == no_body || height <= height_m) continue;
    body = hit;
    height_m = height;
  }
  return body;
}

Motion pick_and_place(const Bodies& bodies, const Action& action) {
  PhysicsWorld& world = bodies.world;
  Clock clock(world);
  double height = 0;
  const int body = under_suction(world, action.pose0.position_m, height);
  if (body == no_body || bodies.fixed[static_cast<std::size_t>(body)]) return {};

  const Vec2 take = action.pose0.position_m, put = action.pose1.position_m;
  const Stance down{{take.x, take.y, height}, 0};
  const Stance up{{take.x, take.y, height + lift_m}, 0};
  Stance over{{put.x, put.y, height + lift_m}, yaw_of(action.pose1.rotation)};
  world.grip(body, down.pose());
  const auto put_gripper = [&](const Stance& stance) { world.move_gripper(stance.pose()); };
  const bool placed = move(clock, down, up, carry_speed, put_gripper) &&
                      move(clock, up, over, carry_speed, put_gripper) &&
                      lower(world, clock, over, body, 0, put_gripper);
  world.release();
  return {body, placed && settle(bodies, clock)};
}

Motion sweep(const Bodies& bodies, const Action& action, const Watch& watch) {
  PhysicsWorld& world = bodies.world;
  const Vec2 from = action.pose0.position_m, to = action.pose1.position_m, way = to - from;
  constexpr double on_table = spatula_size_m.z / 2 + spatula_gap_m;
  Stance stance{{from.x, from.y, on_table + lift_m}, std::atan2(-way.x, way.y)};
  const Vec2 half{spatula_size_m.x / 2, spatula_size_m.y / 2};
  const std::vector<Polygon> blade{{{-half.x, -half.y}, {half.x, -half.y}, {half.x, half.y}, {-half.x, half.y}}};

  Motion motion;
  bool present = true;
  Clock clock(world, [&] {
    if (present && motion.taken == no_body) motion.taken = under_spatula(world);
    const Vec2 at{stance.position_m.x, stance.position_m.y};
    watch(present ? placed(blade, at, stance.yaw_rad) : std::vector<Polygon>{});
  });
  const auto put = [&](const Stance& now) {
    stance = now;
    world.move_spatula(now.pose());
  };
  world.place_spatula(spatula_size_m, stance.pose());
  bool done = lower(world, clock, stance, spatula_body, on_table, put);
  // On top of a body it slides over it, and does not press it into the table.
  if (motion.taken != no_body) stance.position_m.z += lower_speed * world.time_step_s();
  const Stance start = stance, end{{to.x, to.y, start.position_m.z}, start.yaw_rad};
  done = done && move(clock, start, end, push_speed, put);
  world.remove_spatula();
  present = false;
  motion.came_to_rest = done && settle(bodies, clock);
  return motion;
}

}  // namespace lgabench::tabletop
