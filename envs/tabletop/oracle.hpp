// What experts of several tasks build on: taking hold of an object and bringing it somewhere.
#pragma once
#include <vector>

#include <lgabench/core/physics_world.hpp>
#include <lgabench/core/scene.hpp>
#include <tabletop/two_poses.hpp>

namespace lgabench::tabletop {

/// The object's centre now: the middle of its height over its frame's origin, also when it has toppled.
Vec2 centre_of(const SceneObject& object, const Pose& pose);

/// Takes objects[object], turns it, and sets it down with its centre over `goal`. Where the object's grasp point cannot
/// be reached (it has toppled, or something lies on it), takes hold at the nearest point that can. `poses` in the order
/// of `scene.objects`. The world is only looked at.
TwoPoses bring(const Scene& scene, const std::vector<Pose>& poses, const PhysicsWorld& world, std::size_t object,
               Vec2 goal, double turn_rad = 0);

}  // namespace lgabench::tabletop
