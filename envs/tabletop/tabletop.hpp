// The tabletop environment over any engine.
#pragma once
#include <memory>
#include <vector>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/physics_world.hpp>

namespace lgabench::tabletop {

/// So many bodies a scene has at most, which the engine is told, unless a scenario has more distractors than two.
constexpr int most_bodies = 6;

/// Takes the engine, loads every object type of `space` into it once, as each of the variants, and with `matched_sizes`
/// at matched_scales() too, and plays scenes on it, of as many bodies.
std::unique_ptr<Environment> make_environment(std::unique_ptr<PhysicsWorld> world, const FeatureSpace& space,
                                              int bodies = most_bodies, const std::vector<BodyVariant>& variants = {{}},
                                              bool matched_sizes = false);

}  // namespace lgabench::tabletop
