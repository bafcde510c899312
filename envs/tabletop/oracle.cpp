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

/// Of the outline, in the body's frame: the centre of mass, seen from above, of what is equally thick.
Vec2 centroid(const std::vector<Polygon>& outline) {
  Vec2 moment;
  double total = 0;
  for (const Polygon& polygon : outline)
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      const double part = area({polygon[0], polygon[i], polygon[i + 1]});
      moment = moment + part / 3 * (polygon[0] + polygon[i] + polygon[i + 1]);
      total += part;
    }
  return 1 / total * moment;
}

struct Push {
  Vec2 blade_m;  // a point that the blade's middle passes
  double tilt_rad = 0;
};

/// How to push what reaches beyond the blade when it turns. Pushed straight where the face that meets the blade bears
/// the centre of mass; else (an L-shaped block whose notch faces the blade) it would turn in its own time. It is made
/// to turn at once, around the end P of that face: the way passes the centre of mass, and the blade reaches from P to
/// the side that comes to meet it.
Push push_of(Vec2 centre, Vec2 mass, const Polygon& corners, double side) {
  constexpr double flat_m = .002, bears_m = .005, from_end_m = .015, tilt_rad = 15 * pi / 180;
  double back = -1, low = 1, high = -1;
  for (const Vec2 p : corners) back = std::max(back, side * (centre.y - p.y));
  for (const Vec2 p : corners)
    if (side * (centre.y - p.y) > back - flat_m) {
      low = std::min(low, p.x);
      high = std::max(high, p.x);
    }
  if (mass.x - low >= bears_m && high - mass.x >= bears_m) return {centre};
  const double away = mass.x - low < high - mass.x ? 1 : -1;  // from P, along x: where the face is
  const Vec2 end{away > 0 ? low : high, centre.y - side * back};
  const double tilt = -side * away * tilt_rad;
  return {end - rotated({away * (spatula_size_m.x / 2 - from_end_m), 0}, tilt), tilt};
}

/// Along y, or nearly: whatever else a sweep scene holds stands in the other row, or on the obstacle's side.
Action sweep_action(const Scene& scene, const Pose& pose, const SceneObject& object) {
  constexpr double behind_m = .03;
  const SceneObject *target = scene.find(Role::target), *obstacle = scene.find(Role::obstacle);
  if (!target || !obstacle) throw InputError("scene: expected a target and an obstacle");
  const double side = obstacle->position_m.y > target->position_m.y ? -1 : 1;  // the free one
  const ObjectModel& model = object_model(object.object_type);
  const Vec2 centre = centre_of(object, pose);
  const Vec2 mass =
      placed({{centroid(model.outline)}}, {pose.position_m.x, pose.position_m.y}, yaw_of(pose.rotation))[0][0];
  Polygon corners;
  for (const ConvexPiece& piece : model.body.pieces)
    for (const Vec3& corner : piece.corners_m) {
      const Vec3 at = pose.position_m + rotated(corner, pose.rotation);
      corners.push_back({at.x, at.y});
    }
  const Push push = model.radius_m > spatula_size_m.x / 2 ? push_of(centre, mass, corners, side) : Push{centre};
  const Vec2 way = rotated({0, side}, push.tilt_rad);
  const auto dot = [](Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; };
  double reach = 0;  // from the centre back to the object's last corner
  for (const Vec2 corner : corners) reach = std::max(reach, dot(way, centre - corner));
  const Vec2 from = push.blade_m + (dot(way, centre - push.blade_m) - reach - behind_m) * way;
  const double to_y = side * GoalZones::aim_m - (reach + spatula_size_m.y / 2) * way.y;
  return {{from, {}}, {from + (to_y - from.y) / way.y * way, {}}};
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
