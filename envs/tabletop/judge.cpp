#include <tabletop/judge.hpp>

#include <algorithm>
#include <limits>

#include <common/objects.hpp>
#include <tabletop/oracle.hpp>
#include <tabletop/task.hpp>

namespace lgabench::tabletop {
namespace {

std::vector<Final> finals_of(const Scene& scene, const std::vector<Pose>& poses) {
  std::vector<Final> finals;
  finals.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    finals.push_back({scene.objects[i], poses[i], centre_of(scene.objects[i], poses[i]), yaw_of(poses[i].rotation)});
  return finals;
}

double outside_m(Vec2 p) {
  return norm(p - Vec2{std::clamp(p.x, Workspace::x_min, Workspace::x_max),
                       std::clamp(p.y, Workspace::y_min, Workspace::y_max)});
}

}  // namespace

Failure judge(const Scene& scene, const std::vector<Pose>& poses, const Motion& motion, const JudgeLimits& limits) {
  const Task& task = find_task(scene.task);
  const std::vector<Final> finals = finals_of(scene, poses);
  expect(scene, role::target);

  if (!motion.came_to_rest) return failure::truncated;
  for (const Final& f : finals)
    if (!Workspace::contains(f.centre_m)) return failure::left_workspace;
  if (motion.failure != failure::none) return motion.failure;
  // Any target is right; which one was taken says more of a failure than where the others went.
  const SceneObject* const taken =
      motion.taken == no_body ? nullptr : &scene.objects[static_cast<std::size_t>(motion.taken)];
  Failure of_taken = failure::none;
  for (const Final& f : finals) {
    if (f.object.role != role::target) continue;
    const Failure word = task.judge(scene, f, finals, limits);
    if (word == failure::none) return word;
    if (&f.object == taken) of_taken = word;
  }
  if (!taken) return failure::missed_object;
  if (taken->role == role::target) return of_taken;
  return taken->role == role::not_meant ? failure::not_meant : failure::wrong_object;
}

std::vector<Gap> gaps(const Scene& scene, const TwoPoses& action, const std::vector<Pose>& before,
                      const std::vector<Pose>& poses, const Motion& motion) {
  const Task& task = find_task(scene.task);
  const std::vector<Final> finals = finals_of(scene, poses);
  const bool success = judge(scene, poses, motion) == failure::none;
  const auto reach_m = [&](std::size_t i) {
    const Vec2 at{before[i].position_m.x, before[i].position_m.y};
    return task.reach_m(action, placed_outline(model_of(scene.objects[i]), at, yaw_of(before[i].rotation)));
  };
  std::size_t target = finals.size();
  double least_m = 0, furthest_m = 0;
  bool taken = false;
  for (std::size_t i = 0; i < finals.size(); ++i) {
    furthest_m = std::max(furthest_m, outside_m(finals[i].centre_m));
    if (finals[i].object.role != role::target || taken) continue;
    taken = success ? task.judge(scene, finals[i], finals, {}) == failure::none : static_cast<int>(i) == motion.taken;
    const double away_m = taken ? 0 : reach_m(i);
    if (target != finals.size() && !taken && away_m >= least_m) continue;
    target = i;
    least_m = away_m;
  }
  std::vector<Gap> all{{"reach_m", least_m}, {"pick", taken ? 0. : 1.}};
  for (Gap& gap : task.gaps(scene, finals[target], finals, motion)) all.push_back(std::move(gap));
  all.push_back({"outside_m", furthest_m});
  return all;
}

double off_m(const Scene& scene, const std::vector<Pose>& poses) {
  expect(scene, role::target);
  const std::vector<Final> finals = finals_of(scene, poses);
  double least_m = std::numeric_limits<double>::infinity();
  for (const Final& f : finals)
    if (f.object.role == role::target) least_m = std::min(least_m, find_task(scene.task).off_m(scene, f, finals));
  return least_m;
}

}  // namespace lgabench::tabletop
