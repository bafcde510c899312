#include <tabletop/predicates.hpp>

#include <cmath>

#include <lgabench/core/error.hpp>
#include <tabletop/objects.hpp>

namespace lgabench::tabletop {
namespace {

constexpr double near_m = 0.1;          // of the goal's centre, or of where a rotated target was
constexpr double undisturbed_m = 0.02;  // rotate: how far a distractor may move
constexpr double angle_tolerance_deg = 15;
constexpr double pi = 3.14159265358979323846;

struct Final {
  const SceneObject& object;
  Vec2 centre_m;
  double yaw_rad;
};

Failure judge_pick_and_place(const Final& target, const std::vector<Final>& finals) {
  const Final* goal = nullptr;
  for (const Final& f : finals)
    if (f.object.role == Role::goal) goal = &f;
  if (!goal) throw InputError("scene: expected a goal to place the target on");
  if (norm(target.centre_m - goal->centre_m) > near_m) return Failure::bad_placement;
  for (const Final& f : finals)
    if (f.object.role == Role::distractor && norm(f.centre_m - goal->centre_m) <= near_m) return Failure::bad_placement;
  return Failure::none;
}

Failure judge_rotate(const Final& target, const std::vector<Final>& finals, double angle_rad) {
  if (norm(target.centre_m - target.object.position_m) > near_m) return Failure::bad_placement;
  for (const Final& f : finals)
    if (f.object.role == Role::distractor && norm(f.centre_m - f.object.position_m) > undisturbed_m)
      return Failure::bad_placement;
  const double error = std::remainder(target.yaw_rad - target.object.yaw_rad - angle_rad, 2 * pi);
  return std::abs(error) <= angle_tolerance_deg * pi / 180 ? Failure::none : Failure::bad_angle;
}

Failure judge_task(const Scene& scene, const Final& target, const std::vector<Final>& finals) {
  switch (scene.task) {
    case Task::pick_and_place:
      return judge_pick_and_place(target, finals);
    case Task::rotate:
      return judge_rotate(target, finals, scene.angle_rad);
    case Task::sweep:
      break;
  }
  throw InputError("task: expected pick_and_place or rotate, got " + to_string(scene.task));
}

}  // namespace

Vec2 centre_of(const SceneObject& object, const Pose& pose) {
  const Vec3 centre =
      pose.position_m + rotated(Vec3{0, 0, object_model(object.object_type).height_m / 2}, pose.rotation);
  return {centre.x, centre.y};
}

Failure judge(const Scene& scene, const std::vector<Pose>& poses, const Motion& motion) {
  std::vector<Final> finals;
  const Final* target = nullptr;
  finals.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    finals.push_back({scene.objects[i], centre_of(scene.objects[i], poses[i]), yaw_of(poses[i].rotation)});
    if (scene.objects[i].role == Role::target) target = &finals.back();
  }
  if (!target) throw InputError("scene: expected a target");

  if (!motion.came_to_rest) return Failure::truncated;
  for (const Final& f : finals)
    if (!Workspace::contains(f.centre_m)) return Failure::left_workspace;
  const Failure failure = judge_task(scene, *target, finals);
  if (failure == Failure::none) return failure;
  // Why the state is not right: what was taken says more than where it went.
  if (motion.taken == no_body) return Failure::missed_object;
  if (&scene.objects[static_cast<std::size_t>(motion.taken)] != &target->object) return Failure::wrong_object;
  return failure;
}

}  // namespace lgabench::tabletop
