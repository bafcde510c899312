#include <tabletop/judge.hpp>

#include <tabletop/oracle.hpp>
#include <tabletop/task.hpp>

namespace lgabench::tabletop {

Failure judge(const Scene& scene, const std::vector<Pose>& poses, const Motion& motion) {
  const Task& task = find_task(scene.task);
  std::vector<Final> finals;
  finals.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    finals.push_back({scene.objects[i], poses[i], centre_of(scene.objects[i], poses[i]), yaw_of(poses[i].rotation)});
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
    const Failure word = task.judge(scene, f, finals);
    if (word == failure::none) return word;
    if (&f.object == taken) of_taken = word;
  }
  if (!taken) return failure::missed_object;
  if (taken->role == role::target) return of_taken;
  return taken->role == role::not_meant ? failure::not_meant : failure::wrong_object;
}

}  // namespace lgabench::tabletop
