#include <mobile/judge.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <mobile/receivers.hpp>

namespace lgabench::mobile {
namespace {

constexpr double fallen_m = .70;   // the height of a centre below which it has left the table
constexpr double moved_m = .05;    // of a centre: more is not where it was
constexpr double leaning_m = .12;  // a tall thing's centre, where it leans in the vessel

Vec3 centre_of(const SceneObject& object, const Pose& pose) {
  return pose.position_m + rotated(Vec3{0, 0, model_of(object).height_m / 2}, pose.rotation);
}

bool rests_in(const Vessel& vessel, Vec3 centre) {
  return vessel.outer().contains({centre.x, centre.y}) && centre.z > vessel.floor_m &&
         centre.z < vessel.rim_m + leaning_m;
}

double off_m(Vec3 centre, const Task& task) {
  return std::hypot(centre.x - task.goal.centre.x, centre.y - task.goal.centre.y);
}

}  // namespace

Failure judge(const Scene& scene, const Task& task, const std::vector<Pose>& before, const std::vector<Pose>& now,
              std::size_t taken, const JudgeLimits& limits) {
  const Vec3 centre = centre_of(scene.objects[taken], now[taken]);
  for (const Vessel& wrong : task.wrong)
    if (rests_in(wrong, centre)) return failure::wrong_receiver;
  if (!rests_in(task.goal, centre) || (limits.position_m && off_m(centre, task) > *limits.position_m))
    return failure::dropped_elsewhere;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (i == taken) continue;
    const Vec3 is = centre_of(scene.objects[i], now[i]), way = is - centre_of(scene.objects[i], before[i]);
    if (is.z < fallen_m || std::sqrt(dot(way, way)) > moved_m) return failure::moved_another;
  }
  return failure::none;
}

std::vector<Gap> gaps(const Scene& scene, const Task& task, const std::vector<Pose>& before,
                      const std::vector<Pose>& now, std::size_t taken) {
  const Vec3 centre = centre_of(scene.objects[taken], now[taken]);
  const double aside_m = task.goal.outer().away({centre.x, centre.y});
  const double below_m = std::max({0., task.goal.floor_m - centre.z, centre.z - task.goal.rim_m - leaning_m});
  double others_m = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (i == taken) continue;
    const Vec3 is = centre_of(scene.objects[i], now[i]), way = is - centre_of(scene.objects[i], before[i]);
    others_m = std::max({others_m, fallen_m - is.z, std::sqrt(dot(way, way)) - moved_m});
  }
  return {{"place_m", std::hypot(aside_m, below_m)}, {"others_m", others_m}};
}

double off_m(const Scene& scene, const Task& task, const std::vector<Pose>& now) {
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < now.size(); ++i)
    if (scene.objects[i].role == role::target)
      least_m = std::min(least_m, off_m(centre_of(scene.objects[i], now[i]), task));
  return least_m;
}

}  // namespace lgabench::mobile
