#include <tabletop/tasks/pick_and_place.hpp>

#include <algorithm>

#include <common/objects.hpp>
#include <tabletop/oracle.hpp>

namespace lgabench::tabletop {
namespace {

bool is_other(const Final& f) { return f.object.role == role::distractor || f.object.role == role::not_meant; }

Vec2 goal_of(const Scene& scene, const std::vector<Final>& finals) {
  return finals[static_cast<std::size_t>(&expect(scene, role::goal) - scene.objects.data())].centre_m;
}

}  // namespace

std::vector<Layout> PickAndPlace::layouts() const {
  constexpr Vec2 pallet{.5, .3}, released_pallet{.625, .125};
  return {{"cells", four_places(), four_places(), pallet},
          {"continuous", {}, {}, pallet},
          released_layout(released_pallet)};
}

// A large target reaches beyond the pallet that it is brought to.
std::vector<Polygon> PickAndPlace::room(const Layout& layout, const SceneObject& target) const {
  return placed_outline(model_of(target), *layout.pallet, target.yaw_rad);
}

TwoPoses PickAndPlace::expert_action(const Scene& scene, const std::vector<Pose>& poses, const PhysicsWorld& world,
                                     std::size_t object) const {
  return bring(scene, poses, world, object, expect(scene, role::goal).position_m);
}

Failure PickAndPlace::judge(const Scene& scene, const Final& target, const std::vector<Final>& finals,
                            const JudgeLimits& limits) const {
  const Vec2 goal = goal_of(scene, finals);
  if (off_m(scene, target, finals) > limits.position_m.value_or(placed_within_m)) return failure::bad_placement;
  for (const Final& f : finals)
    if (is_other(f) && norm(f.centre_m - goal) <= placed_within_m) return failure::bad_placement;
  return failure::none;
}

double PickAndPlace::off_m(const Scene& scene, const Final& target, const std::vector<Final>& finals) const {
  return norm(target.centre_m - goal_of(scene, finals));
}

std::vector<Gap> PickAndPlace::gaps(const Scene& scene, const Final& target, const std::vector<Final>& finals,
                                    const Motion&) const {
  const Vec2 goal = goal_of(scene, finals);
  double others_m = 0;
  for (const Final& f : finals)
    if (is_other(f)) others_m = std::max(others_m, placed_within_m - norm(f.centre_m - goal));
  return {{"place_m", std::max(0., off_m(scene, target, finals) - placed_within_m)}, {"others_m", others_m}};
}

const Task& task_pick_and_place() {
  static const PickAndPlace task;
  return task;
}

}  // namespace lgabench::tabletop
