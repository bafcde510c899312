// Success and failure: what an episode's end says about it (docs/protocol.md, section 2).
#pragma once
#include <vector>

#include <lgabench/core/scene.hpp>
#include <tabletop/motions.hpp>

namespace lgabench::tabletop {

/// Judges the state that was reached against the scene's beginning; any of several targets is right. What was taken
/// decides the failure's word, not success. `poses` in the order of `scene.objects`. Pure. @throws InputError where the
/// scene lacks a target, or an object that its task needs.
Failure judge(const Scene& scene, const std::vector<Pose>& poses, const Motion& motion);

}  // namespace lgabench::tabletop
