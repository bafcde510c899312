// The tabletop environment over any engine.
#pragma once
#include <memory>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/physics_world.hpp>

namespace lgabench::tabletop {

/// In one scene: the most that a scenario can ask for, and what the engine is told.
constexpr int most_bodies = 6;

/// Takes the engine, loads every object type of `space` into it once, and plays scenes on it.
std::unique_ptr<Environment> make_environment(std::unique_ptr<PhysicsWorld> world, const FeatureSpace& space);

}  // namespace lgabench::tabletop
