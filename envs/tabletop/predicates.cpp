#include <tabletop/predicates.hpp>

#include <algorithm>
#include <cmath>

#include <lgabench/core/error.hpp>
#include <tabletop/objects.hpp>
#include <tabletop/zones.hpp>

namespace lgabench::tabletop {
namespace {

constexpr double near_m = 0.1;          // of the goal's centre, or of where a rotated target was
constexpr double undisturbed_m = 0.02;  // rotate: how far a distractor may move
constexpr double angle_tolerance_deg = 15;

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

Failure judge_sweep(const Final& target, const Motion& motion) {
  if (motion.touched_obstacle) return Failure::touched_obstacle;
  return GoalZones::contains(target.centre_m) ? Failure::none : Failure::missed_zone;
}

Failure judge_task(const Scene& scene, const Final& target, const std::vector<Final>& finals, const Motion& motion) {
  switch (scene.task) {
    case Task::pick_and_place:
      return judge_pick_and_place(target, finals);
    case Task::rotate:
      return judge_rotate(target, finals, scene.angle_rad);
    case Task::sweep:
      return judge_sweep(target, motion);
  }
  throw Error("a Task outside its enumeration");
}

}  // namespace

Vec2 centre_of(const SceneObject& object, const Pose& pose) {
  const Vec3 centre =
      pose.position_m + rotated(Vec3{0, 0, object_model(object.object_type).height_m / 2}, pose.rotation);
  return {centre.x, centre.y};
}

bool touches_obstacle(const Scene& scene, const std::vector<Pose>& poses, const std::vector<Contact>& contacts,
                      const std::vector<Polygon>& spatula) {
  for (const Role role : {Role::target, Role::obstacle})
    if (!scene.find(role)) throw InputError("scene: expected an object to be " + to_string(role));
  const auto role_of = [&](int body) {
    return body < 0 ? Role::distractor : scene.objects[static_cast<std::size_t>(body)].role;
  };
  const auto moves = [&](int body) { return body == spatula_body || role_of(body) == Role::target; };
  const auto is_touch = [&](const Contact& c) {
    return (role_of(c.a) == Role::obstacle && moves(c.b)) || (role_of(c.b) == Role::obstacle && moves(c.a));
  };
  if (std::any_of(contacts.begin(), contacts.end(), is_touch)) return true;

  std::vector<std::vector<Polygon>> barred, moving;
  if (!spatula.empty()) moving.push_back(spatula);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const auto outline = [&] {
      return placed_outline(object_model(scene.objects[i].object_type), {poses[i].position_m.x, poses[i].position_m.y},
                            yaw_of(poses[i].rotation));
    };
    if (scene.objects[i].role == Role::obstacle) barred.push_back(outline());
    if (scene.objects[i].role == Role::target) moving.push_back(outline());
  }
  for (const auto& a : barred)
    for (const auto& b : moving)
      if (distance(a, b) <= 0) return true;
  return false;
}

Failure judge(const Scene& scene, const std::vector<Pose>& poses, const Motion& motion) {
  std::vector<Final> finals;
  finals.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    finals.push_back({scene.objects[i], centre_of(scene.objects[i], poses[i]), yaw_of(poses[i].rotation)});
  if (!scene.find(Role::target)) throw InputError("scene: expected a target");

  if (!motion.came_to_rest) return Failure::truncated;
  for (const Final& f : finals)
    if (!Workspace::contains(f.centre_m)) return Failure::left_workspace;
  // Any target is right; which one was taken says more of a failure than where the others went.
  const SceneObject* const taken =
      motion.taken == no_body ? nullptr : &scene.objects[static_cast<std::size_t>(motion.taken)];
  Failure of_taken = Failure::none;
  for (const Final& f : finals) {
    if (f.object.role != Role::target) continue;
    const Failure failure = judge_task(scene, f, finals, motion);
    if (failure == Failure::none || failure == Failure::touched_obstacle) return failure;
    if (&f.object == taken) of_taken = failure;
  }
  if (!taken) return Failure::missed_object;
  return taken->role == Role::target ? of_taken : Failure::wrong_object;
}

}  // namespace lgabench::tabletop
