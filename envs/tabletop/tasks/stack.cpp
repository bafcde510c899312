// Stack: put the target on the object that the command names.
#include <algorithm>

#include <common/objects.hpp>
#include <tabletop/oracle.hpp>
#include <tabletop/task.hpp>

namespace lgabench::tabletop {
namespace {

constexpr const char* support = "support";

// Where something is set down on an object: over the point at which suction would take it, on material.
Vec2 top_of(const SceneObject& object, const Pose& pose) {
  const ObjectModel& model = model_of(object);
  const Vec3 top = pose.position_m + rotated(Vec3{model.grasp_m.x, model.grasp_m.y, model.height_m}, pose.rotation);
  return {top.x, top.y};
}

double lowest_z(const Final& object) {
  double lowest = lift_m;
  for (const ConvexPiece& piece : model_of(object.object).body.pieces)
    for (const Vec3& corner : piece.corners_m)
      lowest = std::min(lowest, (object.pose.position_m + rotated(corner, object.pose.rotation)).z);
  return lowest;
}

std::vector<Polygon> outline_of(const Final& object) {
  return placed_outline(model_of(object.object), {object.pose.position_m.x, object.pose.position_m.y}, object.yaw_rad);
}

bool is_over(const Final& object, const Final& below) {
  const auto outline = outline_of(below);
  return std::any_of(outline.begin(), outline.end(),
                     [&](const Polygon& polygon) { return contains(polygon, object.centre_m); });
}

class Stack final : public Task {
 public:
  std::string id() const override { return "stack"; }
  std::vector<std::string> failures() const override { return {failure::bad_placement}; }
  std::string example() const override { return "stack_small_block_on_hexagon"; }
  std::optional<SecondObjects> second() const override {
    return SecondObjects{{"onto", "the object to put it on"}, support};
  }
  std::vector<Layout> layouts() const override { return {{"cells", four_places(), four_places()}, {"continuous"}}; }

  TwoPoses expert_action(const Scene& scene, const std::vector<Pose>& poses, const PhysicsWorld& world,
                         std::size_t object) const override {
    const SceneObject& onto = expect(scene, support);
    const Pose& pose = poses[static_cast<std::size_t>(&onto - scene.objects.data())];
    return bring(scene, poses, world, object, top_of(onto, pose));
  }

  // The centre is over the support's outline, and all of the target above half of the support's height.
  Failure judge(const Scene& scene, const Final& target, const std::vector<Final>& finals,
                const JudgeLimits& limits) const override {
    const Final& onto = finals[static_cast<std::size_t>(&expect(scene, support) - scene.objects.data())];
    const double least_z = model_of(onto.object).height_m / 2;
    const bool near = !limits.position_m || off_m(scene, target, finals) <= *limits.position_m;
    return near && is_over(target, onto) && lowest_z(target) > least_z ? failure::none : failure::bad_placement;
  }

  double off_m(const Scene& scene, const Final& target, const std::vector<Final>& finals) const override {
    const Final& onto = finals[static_cast<std::size_t>(&expect(scene, support) - scene.objects.data())];
    return norm(target.centre_m - top_of(onto.object, onto.pose));
  }
  std::vector<Gap> gaps(const Scene& scene, const Final& target, const std::vector<Final>& finals,
                        const Motion&) const override {
    const Final& onto = finals[static_cast<std::size_t>(&expect(scene, support) - scene.objects.data())];
    return {{"place_m", distance(target.centre_m, outline_of(onto))},
            {"height_m", std::max(0., model_of(onto.object).height_m / 2 - lowest_z(target))}};
  }
};

}  // namespace

const Task& task_stack() {
  static const Stack task;
  return task;
}

}  // namespace lgabench::tabletop
