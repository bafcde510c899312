// What perturbations change in a scene, whatever its environment.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/physics_world.hpp>
#include <lgabench/core/scene.hpp>

namespace lgabench::common {

/// The body with the variant's friction and mass; its size is its model's.
BodyModel varied(BodyModel body, const BodyVariant& variant);

/// The scene with everything of that size that can be moved.
Scene resized(Scene scene, double scale, const std::function<bool(const SceneObject&)>& movable);

/// The scene with its first target of the greatest of `scales`, which grow, at which it and those before it leave room.
/// `fits` is asked of a scene and of the target's index.
Scene with_larger_target(Scene scene, const std::vector<double>& scales,
                         const std::function<bool(const Scene&, std::size_t target)>& fits);

/// What a larger target leaves free around it.
constexpr double room_left_m = .005;

/// A perturbation adds so many distractors at most.
constexpr int most_added = 4;

/// How one is added to a scene's objects, the target first: `draw` gives one without a place, none where that draw
/// gives none (`draw`: which it is, from 0); `place` places the last among the others, false where there is no room.
struct Adding {
  std::function<std::optional<SceneObject>(const std::vector<SceneObject>& objects, int draw)> draw;
  std::function<bool(std::vector<SceneObject>& objects)> place;
};
/// The scene with so many more: one after another, so that fewer are the first of more. Ids are given anew, in an order
/// of `random` that all numbers share. @throws NothingToShow where 60 draws find no room.
Scene with_more(const Scene& scene, int count, RandomStream& random, const Adding& adding);

}  // namespace lgabench::common
