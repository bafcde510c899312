// The expert: the action that does the task, from the true state.
#pragma once
#include <vector>

#include <lgabench/core/action.hpp>
#include <lgabench/core/scene.hpp>
#include <tabletop/primitives.hpp>

namespace lgabench::tabletop {

/// What does the scene's task in the present state, with objects[object] as the target. `poses` in the order of
/// `scene.objects`. pick_and_place: the object's centre lands on the goal's; rotate: on where the object was, turned by
/// what is left of the scene's angle; sweep: the spatula starts .03 behind the object and brings its centre straight
/// into the goal zone on the side that the obstacle leaves free, along y, or tilted by 15 degrees where the object
/// would not lie still on the blade. Where the object's grasp point cannot be reached (it has toppled, or something
/// lies on it), takes hold at the nearest point that can. The world is only looked at.
Action expert_action(const Scene& scene, const std::vector<Pose>& poses, const PhysicsWorld& world, std::size_t object);

}  // namespace lgabench::tabletop
