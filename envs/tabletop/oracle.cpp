#include <tabletop/oracle.hpp>

#include <algorithm>
#include <cmath>

#include <lgabench/core/error.hpp>
#include <tabletop/objects.hpp>
#include <tabletop/predicates.hpp>
#include <tabletop/zones.hpp>

namespace lgabench::tabletop {
namespace {

/// Where suction would take this object: its grasp point, else the nearest point around it where it is topmost.
Vec2 reachable_grasp(const SceneObject& object, const Pose& pose, const PhysicsWorld& world, int body) {
  const ObjectModel& model = object_model(object.object_type);
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

/// Straight along y: whatever else a sweep scene holds stands in the other row, or on the obstacle's side.
Action sweep_action(const Scene& scene, const Pose& pose, const SceneObject& object) {
  constexpr double behind_m = .03;
  const SceneObject *target = scene.find(Role::target), *obstacle = scene.find(Role::obstacle);
  if (!target || !obstacle) throw InputError("scene: expected a target and an obstacle");
  const double side = obstacle->position_m.y > target->position_m.y ? -1 : 1;  // the free one
  const Vec2 centre = centre_of(object, pose);
  double reach = 0;  // from the centre back to the object's last corner
  for (const ConvexPiece& piece : object_model(object.object_type).body.pieces)
    for (const Vec3& corner : piece.corners_m)
      reach = std::max(reach, side * (centre.y - (pose.position_m + rotated(corner, pose.rotation)).y));
  return {{{centre.x, centre.y - side * (reach + behind_m)}, {}},
          {{centre.x, side * (GoalZones::aim_m - reach - spatula_size_m.y / 2)}, {}}};
}

}  // namespace

Action expert_action(const Scene& scene, const std::vector<Pose>& poses, const PhysicsWorld& world,
                     std::size_t object) {
  const SceneObject& target = scene.objects[object];
  const Vec2 centre = centre_of(target, poses[object]);
  Vec2 goal;
  double turn = 0;
  switch (scene.task) {
    case Task::pick_and_place: {
      const SceneObject* place = scene.find(Role::goal);
      if (!place) throw InputError("scene: expected a goal to place the target on");
      goal = place->position_m;
      break;
    }
    case Task::rotate:
      goal = target.position_m;
      turn = std::remainder(target.yaw_rad + scene.angle_rad - yaw_of(poses[object].rotation), 2 * pi);
      break;
    case Task::sweep:
      return sweep_action(scene, poses[object], target);
  }
  const Vec2 grasp = reachable_grasp(target, poses[object], world, static_cast<int>(object));
  return {{grasp, {}}, {goal + rotated(grasp - centre, turn), from_yaw(turn)}};
}

}  // namespace lgabench::tabletop
