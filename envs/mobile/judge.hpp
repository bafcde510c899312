// Success and failure of a plan that was carried out (docs/protocol.md, section 7).
#pragma once
#include <vector>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/scene.hpp>
#include <mobile/mobile.hpp>

namespace lgabench::mobile {

/// Poses in the order of `scene.objects`, at rest: as they were at the scene's beginning, and now. `taken`: the object
/// that was carried, a target. Pure. @returns failure::none, wrong_receiver,
/// dropped_elsewhere or moved_another.
Failure judge(const Scene& scene, const Task& task, const std::vector<Pose>& before, const std::vector<Pose>& now,
              std::size_t taken, const JudgeLimits& limits = {});

/// How far the nearest target's centre is from the middle of where it is to be brought, seen from above, in metres.
double off_m(const Scene& scene, const Task& task, const std::vector<Pose>& now);

/// How far that is from success (StepResult::gaps): `place_m` from the goal to what was carried, and `others_m` that
/// another moved beyond what it may. Arguments as above. Pure.
std::vector<Gap> gaps(const Scene& scene, const Task& task, const std::vector<Pose>& before,
                      const std::vector<Pose>& now, std::size_t taken);

}  // namespace lgabench::mobile
