// Sweep: push the target into one of the two strips at the table's sides, without touching the obstacle.
#include <tabletop/tasks/sweep.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <common/objects.hpp>
#include <tabletop/oracle.hpp>
#include <tabletop/task.hpp>
#include <tabletop/zones.hpp>

namespace lgabench::tabletop {
namespace {

constexpr const char *obstacle = "obstacle", *distances = "barrier_distances_m";
constexpr const char *missed_zone = "missed_zone", *touched_obstacle = "touched_obstacle";

/// Along the blade, through it, upright. The width: docs/protocol.md, section 2.
constexpr Vec3 spatula_size_m{0.12, 0.01, 0.05};
constexpr double spatula_gap_m = 5e-4;  // to the table, which it need not scrape: less than the thinnest body
constexpr double push_speed = 0.25;     // m/s
constexpr double aim_m = 0.41;          // |y| that the oracle brings the target's centre to

Polygon blade_outline() {
  const Vec2 half{spatula_size_m.x / 2, spatula_size_m.y / 2};
  return {{-half.x, -half.y}, {half.x, -half.y}, {half.x, half.y}, {-half.x, half.y}};
}

std::vector<Pose> poses_of(const Scene& scene, const PhysicsWorld& world) {
  std::vector<Pose> all;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) all.push_back(world.pose(static_cast<int>(i)));
  return all;
}

/// A body that the spatula touches: no_body if none.
int under_spatula(const PhysicsWorld& world) {
  for (const Contact c : world.contacts())
    if (std::min(c.a, c.b) == spatula_body && std::max(c.a, c.b) >= 0) return std::max(c.a, c.b);
  return no_body;
}

/// Centre of mass of what is equally thick within the outline, seen from above; in the body's frame.
Vec2 centroid(const std::vector<Polygon>& outline) {
  Vec2 moment;
  double total = 0;
  for (const Polygon& polygon : outline)
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      const double part = area({polygon[0], polygon[i], polygon[i + 1]});
      moment = moment + part / 3 * (polygon[0] + polygon[i] + polygon[i + 1]);
      total += part;
    }
  return 1 / total * moment;
}

struct Push {
  Vec2 blade_m;  // a point that the blade's middle passes
  double tilt_rad = 0;
};

/// How to push what reaches beyond the blade when it turns. Straight, where the centre of mass is in front of the face
/// that meets the blade. An object for which it is not (an L-shaped block with its notch towards the blade) would turn
/// at some point on the way. It is made to turn at once, about the end P of that face: the blade moves on a tilted
/// line, and reaches from P to the side of the object that turns towards it.
Push push_of(Vec2 centre, Vec2 mass, const Polygon& corners, double side) {
  constexpr double flat_m = .002, bears_m = .005, from_end_m = .015, tilt_rad = 15 * pi / 180;
  double back = -1, low = 1, high = -1;
  for (const Vec2 p : corners) back = std::max(back, side * (centre.y - p.y));
  for (const Vec2 p : corners)
    if (side * (centre.y - p.y) > back - flat_m) {
      low = std::min(low, p.x);
      high = std::max(high, p.x);
    }
  if (mass.x - low >= bears_m && high - mass.x >= bears_m) return {centre};
  const double away = mass.x - low < high - mass.x ? 1 : -1;  // from P, along x: where the face is
  const Vec2 end{away > 0 ? low : high, centre.y - side * back};
  const double tilt = -side * away * tilt_rad;
  return {end - rotated({away * (spatula_size_m.x / 2 - from_end_m), 0}, tilt), tilt};
}

/// The spatula starts .03 behind the object and brings its centre straight into the goal zone on the side that the
/// obstacle leaves free. Along y, or nearly: whatever else a sweep scene holds stands in the other row, or on the
/// obstacle's side.
TwoPoses sweep_action(const Scene& scene, const Pose& pose, const SceneObject& object) {
  constexpr double behind_m = .03;
  const bool bars_upper = expect(scene, obstacle).position_m.y > expect(scene, role::target).position_m.y;
  const double side = bars_upper ? -1 : 1;  // the free one
  const ObjectModel& model = model_of(object);
  const Vec2 centre = centre_of(object, pose);
  const Vec2 mass =
      placed({{centroid(model.outline)}}, {pose.position_m.x, pose.position_m.y}, yaw_of(pose.rotation))[0][0];
  Polygon corners;
  for (const ConvexPiece& piece : model.body.pieces)
    for (const Vec3& corner : piece.corners_m) {
      const Vec3 at = pose.position_m + rotated(corner, pose.rotation);
      corners.push_back({at.x, at.y});
    }
  const Push push = model.radius_m > spatula_size_m.x / 2 ? push_of(centre, mass, corners, side) : Push{centre};
  const Vec2 way = rotated({0, side}, push.tilt_rad);
  const auto dot = [](Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; };
  double reach = 0;  // from the centre back to the object's last corner
  for (const Vec2 corner : corners) reach = std::max(reach, dot(way, centre - corner));
  const Vec2 from = push.blade_m + (dot(way, centre - push.blade_m) - reach - behind_m) * way;
  const double to_y = side * aim_m - (reach + spatula_size_m.y / 2) * way.y;
  return {{from, {}}, {from + (to_y - from.y) / way.y * way, {}}};
}

// The spatula is .12 wide: wider targets slip off it. Obstacle and distractors stand where the target's place says.
Layout layout(const std::string& id, double shift_m) {
  const std::vector<Vec2> places{{.375, -.05}, {.375, .05}, {.625, -.05}, {.625, .05}};
  return {id, places, {}, {}, Layout::unbounded, .145, shift_m};
}

class Sweep final : public Task {
 public:
  std::string id() const override { return "sweep"; }
  std::vector<std::string> failures() const override { return {missed_zone, touched_obstacle}; }
  std::string example() const override { return "sweep_block_without_touching_pan"; }
  std::optional<SecondObjects> second() const override {
    return SecondObjects{{"avoid", "the object to be avoided"}, obstacle};
  }
  std::vector<Layout> layouts() const override {
    return {layout("cells", 0), layout("continuous", .03), layout("released", 0)};
  }
  Ground ground() const override { return Ground::goal_zones; }

  // How far from the target, along y, what bars a side alone stands; each with equal odds, one a scene.
  std::vector<std::string> scene_members() const override { return {distances}; }
  void read(const JsonReader&, const JsonReader* scenes, Content& content) const override {
    constexpr double usual_m = .21, nearest_m = .15, farthest_m = .3;  // outlines apart, and within the picture
    constexpr std::size_t most_choice = 2;                             // place() has no room beside the target for more
    if (content.choice.size() > most_choice)
      scenes->at("choice").fail(fmt::format("at most {} object types for sweep", most_choice));
    if (!scenes || !scenes->has(distances)) {
      content.numbers[distances] = {usual_m};
      return;
    }
    std::vector<double>& read = content.numbers[distances];
    for (const JsonReader& distance : scenes->at(distances).elements()) {
      read.push_back(distance.number());
      if (!(distance.number() >= nearest_m && distance.number() <= farthest_m))
        distance.fail(fmt::format("{} to {}", nearest_m, farthest_m));
    }
    if (read.empty()) scenes->at(distances).fail("at least one distance");
  }

  // docs/suites.md (q3): obstacles bar one side of the target's row, distractors stand in the other row,
  // or where they bar the way themselves (touching them is allowed) opposite the obstacle.
  void place(const Layout& layout, const Content& content, std::vector<SceneObject>& objects,
             const Streams& stream) const override {
    constexpr double distractor_y_m = .16;
    RandomStream random = stream("layout"), others = stream("layout of distractors"), distance = stream("distance");
    const std::vector<double>& distances_m = content.numbers.at(distances);
    const double one_away_m = distances_m[distance.below(static_cast<std::uint32_t>(distances_m.size()))];
    constexpr std::array<double, 2> two_away_m{.17, .25};
    const Vec2 place = layout.target_places[random.below(static_cast<std::uint32_t>(layout.target_places.size()))];
    const double blocked_side = random.coin() ? 1 : -1;
    SceneObject& target = objects[0];
    target.position_m = place;
    if (layout.shift_m > 0) {
      target.position_m.x += random.uniform(-layout.shift_m, layout.shift_m);
      target.position_m.y += random.uniform(-layout.shift_m, layout.shift_m);
    }
    const auto is_obstacle = [](const SceneObject& object) { return object.role == obstacle; };
    const bool two = std::count_if(objects.begin(), objects.end(), is_obstacle) == 2;
    const auto bar = [&](SceneObject& object, double away_m) {
      object.position_m = {place.x, target.position_m.y + away_m};
      object.yaw_rad = pi / 2;
    };
    std::size_t obstacles = 0;
    double distractor_side = others.coin() ? 1 : -1;
    for (SceneObject& object : objects) {
      if (object.role == obstacle) bar(object, blocked_side * (two ? two_away_m.at(obstacles++) : one_away_m));
      if (object.role != role::distractor) continue;
      if (!content.choice.empty()) {
        bar(object, -blocked_side * one_away_m);
      } else {
        object.position_m = {Workspace::x_min + Workspace::x_max - place.x, distractor_side * distractor_y_m};
        distractor_side = -distractor_side;
      }
    }
  }

  // The spatula descends at pose0, its blade across the way to pose1, until it stands on the table or meets a body; is
  // pushed straight to pose1 and taken away; then waits until all bodies rest. The action's rotations do not count.
  Motion carry_out(const Scene& scene, const Bodies& bodies, const TwoPoses& action) const override {
    PhysicsWorld& world = bodies.world;
    const Vec2 from = action.pose0.position_m, to = action.pose1.position_m, way = to - from;
    constexpr double on_table = spatula_size_m.z / 2 + spatula_gap_m;
    Stance stance{{from.x, from.y, on_table + lift_m}, std::atan2(-way.x, way.y)};
    const std::vector<Polygon> blade{blade_outline()};

    Motion motion;
    bool present = true;
    Clock clock(world, [&] {
      if (present && motion.taken == no_body) motion.taken = under_spatula(world);
      const Vec2 at{stance.position_m.x, stance.position_m.y};
      if (motion.failure == failure::none &&
          touches_obstacle(scene, poses_of(scene, world), world.contacts(),
                           present ? placed(blade, at, stance.yaw_rad) : std::vector<Polygon>{}))
        motion.failure = touched_obstacle;
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

  TwoPoses expert_action(const Scene& scene, const std::vector<Pose>& poses, const PhysicsWorld&,
                         std::size_t object) const override {
    return sweep_action(scene, poses[object], scene.objects[object]);
  }

  Failure judge(const Scene& scene, const Final& target, const std::vector<Final>& finals,
                const JudgeLimits& limits) const override {
    const bool near = !limits.position_m || off_m(scene, target, finals) <= *limits.position_m;
    return near && GoalZones::contains(target.centre_m) ? failure::none : missed_zone;
  }

  double off_m(const Scene&, const Final& target, const std::vector<Final>&) const override {
    return std::abs(std::abs(target.centre_m.y) - (GoalZones::near_m + GoalZones::far_m) / 2);
  }
  std::vector<Gap> gaps(const Scene&, const Final& target, const std::vector<Final>&,
                        const Motion& motion) const override {
    const double y_m = std::abs(target.centre_m.y);
    return {{"place_m", std::max({0., GoalZones::near_m - y_m, y_m - GoalZones::far_m})},
            {obstacle, motion.failure == failure::none ? 0. : 1.}};
  }
  // From all that the blade passes over.
  double reach_m(const TwoPoses& action, const std::vector<Polygon>& outline) const override {
    const Vec2 from = action.pose0.position_m, to = action.pose1.position_m, way = to - from;
    Polygon passed;
    for (const Vec2 at : {from, to})
      for (const Polygon& blade : placed({blade_outline()}, at, std::atan2(-way.x, way.y)))
        passed.insert(passed.end(), blade.begin(), blade.end());
    return distance(std::vector<Polygon>{convex_hull(passed)}, outline);
  }
};

}  // namespace

bool touches_obstacle(const Scene& scene, const std::vector<Pose>& poses, const std::vector<Contact>& contacts,
                      const std::vector<Polygon>& spatula) {
  expect(scene, role::target);
  expect(scene, obstacle);
  const auto is = [&](int body, const char* role) {
    return body >= 0 && scene.objects[static_cast<std::size_t>(body)].role == role;
  };
  const auto moves = [&](int body) { return body == spatula_body || is(body, role::target); };
  const auto is_touch = [&](const Contact& c) {
    return (is(c.a, obstacle) && moves(c.b)) || (is(c.b, obstacle) && moves(c.a));
  };
  if (std::any_of(contacts.begin(), contacts.end(), is_touch)) return true;

  std::vector<std::vector<Polygon>> barred, moving;
  if (!spatula.empty()) moving.push_back(spatula);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const auto outline = [&] {
      return placed_outline(model_of(scene.objects[i]), {poses[i].position_m.x, poses[i].position_m.y},
                            yaw_of(poses[i].rotation));
    };
    if (scene.objects[i].role == obstacle) barred.push_back(outline());
    if (scene.objects[i].role == role::target) moving.push_back(outline());
  }
  for (const auto& a : barred)
    for (const auto& b : moving)
      if (distance(a, b) <= 0) return true;
  return false;
}

const Task& task_sweep() {
  static const Sweep task;
  return task;
}

}  // namespace lgabench::tabletop
