// Success and failure: what an episode's end says about it (docs/protocol.md, section 2).
#pragma once
#include <vector>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/scene.hpp>
#include <tabletop/motions.hpp>

namespace lgabench::tabletop {

/// Judges the state that was reached against the scene's beginning; any of several targets is right. What was taken
/// decides the failure's word, not success. `poses` in the order of `scene.objects`. Pure. @throws InputError where the
/// scene lacks a target, or an object that its task needs.
Failure judge(const Scene& scene, const std::vector<Pose>& poses, const Motion& motion, const JudgeLimits& limits = {});

/// How far the nearest target's centre ended from where the task asks for it, in metres. Pure. @throws likewise.
double off_m(const Scene& scene, const std::vector<Pose>& poses);

/// How far from success that state is (StepResult::gaps): `reach_m` from where the action took hold to the target,
/// `pick`, `outside_m` of the working area, and the task's own. Of several targets it is that which succeeded, else
/// that which was taken, else the nearest to the action. `before`: poses when the action began. Pure. @throws likewise.
std::vector<Gap> gaps(const Scene& scene, const TwoPoses& action, const std::vector<Pose>& before,
                      const std::vector<Pose>& poses, const Motion& motion);

}  // namespace lgabench::tabletop
