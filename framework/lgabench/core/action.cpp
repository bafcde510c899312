#include <lgabench/core/action.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

PlanarPose executable(const PlanarPose& pose, const char* name) {
  const Quat q = pose.rotation;
  for (const double v : {pose.position_m.x, pose.position_m.y, q.x, q.y, q.z, q.w})
    if (!std::isfinite(v)) throw MethodError(fmt::format("{}: expected finite numbers, got {}", name, v));
  const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (length < 1e-6)
    throw MethodError(fmt::format("{}: expected a quaternion of norm 1e-6 or more, got {}", name, length));
  return {{std::clamp(pose.position_m.x, Workspace::x_min, Workspace::x_max),
           std::clamp(pose.position_m.y, Workspace::y_min, Workspace::y_max)},
          {q.x / length, q.y / length, q.z / length, q.w / length}};
}

}  // namespace

ActionVector to_vector(const Action& action) {
  ActionVector v{};
  int i = 0;
  for (const PlanarPose& pose : {action.pose0, action.pose1}) {
    const Quat q = pose.rotation;
    const double sign = q.w < 0 ? -1 : 1;
    for (const double value : {pose.position_m.x, pose.position_m.y, sign * q.x, sign * q.y, sign * q.z, sign * q.w})
      v[static_cast<std::size_t>(i++)] = static_cast<float>(value);
  }
  return v;
}

Action from_vector(const ActionVector& v) {
  return {{{v[0], v[1]}, {v[2], v[3], v[4], v[5]}}, {{v[6], v[7]}, {v[8], v[9], v[10], v[11]}}};
}

Action executable(const Action& action) {
  return {executable(action.pose0, "pose0"), executable(action.pose1, "pose1")};
}

}  // namespace lgabench
