#include <tabletop/oracle.hpp>

#include <tabletop/motions.hpp>
#include <tabletop/placement.hpp>

namespace lgabench::tabletop {
namespace {

/// Where suction would take this object: its grasp point, else the nearest point around it where it is topmost.
Vec2 reachable_grasp(const SceneObject& object, const Pose& pose, const PhysicsWorld& world, int body) {
  const ObjectModel& model = model_of(object);
  const Vec3 top = pose.position_m + rotated(Vec3{model.grasp_m.x, model.grasp_m.y, model.height_m}, pose.rotation);
  const Vec2 grasp{top.x, top.y};
  const auto reachable = [&](Vec2 point) {
    double height = 0;
    return Workspace::contains(point) && under_suction(world, point, height) == body;
  };
  constexpr double spacing_m = 0.005;
  constexpr int directions = 16;
  for (double radius = 0; radius <= 2 * model.radius_m + model.height_m; radius += spacing_m)
    for (int i = 0; i < (radius > 0 ? directions : 1); ++i) {
      const Vec2 point = grasp + rotated({radius, 0}, 2 * pi * i / directions);
      if (reachable(point)) return point;
    }
  return grasp;  // wholly covered: the best that is left
}

}  // namespace

Vec2 centre_of(const SceneObject& object, const Pose& pose) {
  const Vec3 centre = pose.position_m + rotated(Vec3{0, 0, model_of(object).height_m / 2}, pose.rotation);
  return {centre.x, centre.y};
}

TwoPoses bring(const Scene& scene, const std::vector<Pose>& poses, const PhysicsWorld& world, std::size_t object,
               Vec2 goal, double turn_rad) {
  const SceneObject& target = scene.objects[object];
  const Vec2 centre = centre_of(target, poses[object]);
  const Vec2 grasp = reachable_grasp(target, poses[object], world, static_cast<int>(object));
  return {{grasp, {}}, {goal + rotated(grasp - centre, turn_rad), from_yaw(turn_rad)}};
}

}  // namespace lgabench::tabletop
