// Rotate: turn the target in its place, by the scenario's angle.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <common/objects.hpp>
#include <tabletop/oracle.hpp>
#include <tabletop/task.hpp>

namespace lgabench::tabletop {
namespace {

constexpr double in_place_m = 0.1;      // of where the target was
constexpr double undisturbed_m = 0.02;  // how far a distractor may move
constexpr double angle_tolerance_deg = 15;
constexpr const char *angle = "angle_deg", *direction = "direction", *bad_angle = "bad_angle";

class Rotate final : public Task {
 public:
  std::string id() const override { return "rotate"; }
  std::vector<std::string> failures() const override { return {failure::bad_placement, bad_angle}; }
  std::string example() const override { return "rotate_block"; }

  std::vector<Layout> layouts() const override {
    const std::vector<Vec2> cells{{.40, -.35}, {.60, -.115}, {.40, .115}, {.60, .35}};
    return {{"cells", cells, cells}, {"continuous"}, released_layout()};
  }

  // Positive: counter-clockwise seen from above.
  std::vector<std::string> scenario_members() const override { return {angle, direction}; }
  void read(const JsonReader& file, const JsonReader*, Content& content) const override {
    const double angle_deg = file.at(angle).number();
    if (!(angle_deg > angle_tolerance_deg && angle_deg <= 180))  // else what is not turned would be right
      file.at(angle).fail(fmt::format("above {:g}, at most 180", angle_tolerance_deg));
    const std::string to = file.has(direction) ? file.at(direction).string() : "counter_clockwise";
    if (to != "clockwise" && to != "counter_clockwise") file.at(direction).fail("clockwise or counter_clockwise");
    content.numbers[angle] = {to == "clockwise" ? -angle_deg : angle_deg};
  }
  double turn_rad(const Content& content) const override { return content.numbers.at(angle).front() * pi / 180; }

  bool judges_turn() const override { return true; }

  // The disc that the target sweeps.
  std::vector<Polygon> room(const Layout&, const SceneObject& target) const override {
    constexpr int corners = 32;
    const double radius_m = model_of(target).radius_m / std::cos(pi / corners);  // around it, not in it
    Polygon disc;
    for (int i = 0; i < corners; ++i) disc.push_back(target.position_m + rotated({radius_m, 0}, 2 * pi * i / corners));
    return {disc};
  }

  TwoPoses expert_action(const Scene& scene, const std::vector<Pose>& poses, const PhysicsWorld& world,
                         std::size_t object) const override {
    const SceneObject& target = scene.objects[object];
    const double left = target.yaw_rad + asked_turn_rad(scene) - yaw_of(poses[object].rotation);
    return bring(scene, poses, world, object, target.position_m, std::remainder(left, 2 * pi));
  }

  Failure judge(const Scene& scene, const Final& target, const std::vector<Final>& finals,
                const JudgeLimits& limits) const override {
    if (off_m(scene, target, finals) > limits.position_m.value_or(in_place_m)) return failure::bad_placement;
    for (const Final& f : finals)
      if (f.object.role == role::distractor && norm(f.centre_m - f.object.position_m) > undisturbed_m)
        return failure::bad_placement;
    const double most_deg = limits.angle_deg.value_or(angle_tolerance_deg);
    return error_rad(scene, target) <= most_deg * pi / 180 ? failure::none : bad_angle;
  }

  double off_m(const Scene&, const Final& target, const std::vector<Final>&) const override {
    return norm(target.centre_m - target.object.position_m);
  }
  std::vector<Gap> gaps(const Scene& scene, const Final& target, const std::vector<Final>& finals,
                        const Motion&) const override {
    double others_m = 0;
    for (const Final& f : finals)
      if (f.object.role == role::distractor)
        others_m = std::max(others_m, norm(f.centre_m - f.object.position_m) - undisturbed_m);
    const double over_rad = std::max(0., error_rad(scene, target) - angle_tolerance_deg * pi / 180);
    return {{"place_m", std::max(0., off_m(scene, target, finals) - in_place_m)},
            {"turn_deg", over_rad * 180 / pi},
            {"others_m", others_m}};
  }

 private:
  static double error_rad(const Scene& scene, const Final& target) {
    return std::abs(std::remainder(target.yaw_rad - target.object.yaw_rad - asked_turn_rad(scene), 2 * pi));
  }
};

}  // namespace

const Task& task_rotate() {
  static const Rotate task;
  return task;
}

}  // namespace lgabench::tabletop
