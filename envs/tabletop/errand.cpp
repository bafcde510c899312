#include <tabletop/errand.hpp>

#include <algorithm>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/turns.hpp>
#include <tabletop/judge.hpp>
#include <tabletop/oracle.hpp>
#include <tabletop/task.hpp>

namespace lgabench::tabletop {
namespace {

Named name_of(const SceneObject& object) { return {object.object_type, object.texture}; }

}  // namespace

Errand::Errand(const Scene& scene) : scene_(&scene) {
  for (const SceneObject& object : scene.objects) on_table_.push_back(object.role != role::later);
}

std::vector<Named> Errand::names_on_table() const {
  std::vector<Named> names;
  for (std::size_t i = 0; i < on_table_.size(); ++i)
    if (on_table_[i] && scene_->objects[i].role != role::goal) names.push_back(name_of(scene_->objects[i]));
  return names;
}

std::vector<std::size_t> Errand::wanted() const {
  const std::vector<Named> names = lgabench::wanted(*scene_->errand, names_on_table(), brought_);
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < on_table_.size(); ++i)
    if (on_table_[i] && contains(names, name_of(scene_->objects[i]))) some.push_back(i);
  return some;
}

bool Errand::is_wanted(std::size_t object) const {
  const std::vector<std::size_t> all = wanted();
  return contains(all, object);
}

bool Errand::is_done() const { return lgabench::is_done(*scene_->errand, names_on_table(), brought_); }

Failure Errand::ended() const { return is_done() ? failure::none : failure::too_early; }

Failure Errand::moved(const std::vector<Pose>& poses, const Motion& motion) {
  if (!motion.came_to_rest) return failure::truncated;
  const std::vector<SceneObject>& objects = scene_->objects;
  const auto goal = static_cast<std::size_t>(&expect(*scene_, role::goal) - objects.data());
  const Vec2 goal_m = centre_of(objects[goal], poses[goal]);
  std::vector<std::size_t> there, lost;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!on_table_[i] || i == goal) continue;
    const Vec2 at = centre_of(objects[i], poses[i]);
    if (norm(at - goal_m) <= placed_within_m) there.push_back(i);
    if (!Workspace::contains(at)) lost.push_back(i);
  }
  const auto is_taken = [&motion](std::size_t i) { return static_cast<int>(i) == motion.taken; };
  std::stable_partition(there.begin(), there.end(), is_taken);
  for (const std::size_t i : there) {
    if (!is_wanted(i)) return !is_taken(i) ? failure::knocked_on : is_done() ? failure::went_on : failure::not_wanted;
    on_table_[i] = false;
    brought_.push_back(name_of(objects[i]));
  }
  if (std::any_of(lost.begin(), lost.end(), [this](std::size_t i) { return is_wanted(i); }))
    return failure::lost_wanted;
  for (const std::size_t i : lost) on_table_[i] = false;
  if (brought_.size() == there.size() && !there.empty())  // the first take
    for (std::size_t i = 0; i < objects.size(); ++i) on_table_[i] = on_table_[i] || objects[i].role == role::later;
  return failure::goes_on;
}

std::vector<Gap> errand_gaps(const Scene& scene, const Errand& errand, const TwoPoses& action,
                             const std::vector<Pose>& before, const std::vector<Pose>& poses, const Motion& motion) {
  const std::vector<std::size_t> wanted = errand.wanted();
  if (wanted.empty()) return {{"reach_m", 0}, {"pick", 0}, {"place_m", 0}, {"others_m", 0}, {"outside_m", 0}};
  Scene now = scene;
  now.objects.clear();
  std::vector<Pose> before_of, poses_of;
  Motion motion_of = motion;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (!errand.on_table(i)) continue;
    if (static_cast<int>(i) == motion.taken) motion_of.taken = static_cast<int>(now.objects.size());
    now.objects.push_back(scene.objects[i]);
    if (Role& of = now.objects.back().role; of != role::goal)
      of = contains(wanted, i) ? role::target : role::distractor;
    before_of.push_back(before[i]);
    poses_of.push_back(poses[i]);
  }
  return gaps(now, action, before_of, poses_of, motion_of);
}

}  // namespace lgabench::tabletop
