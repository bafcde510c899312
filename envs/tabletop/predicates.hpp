// Success and failure: what an episode's end says about it (docs/protocol.md, section 2).
#pragma once
#include <vector>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/physics_world.hpp>
#include <lgabench/core/scene.hpp>
#include <tabletop/outline.hpp>
#include <tabletop/primitives.hpp>

namespace lgabench::tabletop {

/// The object's centre now: the middle of its height over its frame's origin, also when it has toppled.
Vec2 centre_of(const SceneObject& object, const Pose& pose);

/// A target or the spatula touch an obstacle now: in a contact (of the last step), or their outlines overlap seen from
/// above, since a thin obstacle is passed over without contact. `spatula` is its outline, empty where it is not on the
/// table. @throws InputError where the scene lacks a target or an obstacle.
bool touches_obstacle(const Scene& scene, const std::vector<Pose>& poses, const std::vector<Contact>& contacts,
                      const std::vector<Polygon>& spatula);

/// Judges the state that was reached against the scene's beginning; any of several targets is right. `poses` in the
/// order of `scene.objects`. Pure. @throws InputError where the scene lacks a target, or a goal that its task needs.
Failure judge(const Scene& scene, const std::vector<Pose>& poses, const Motion& motion);

}  // namespace lgabench::tabletop
