// Scenes and worlds of a scenario, as its environment makes them.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/physics_world.hpp>
#include <lgabench/core/scenario.hpp>

namespace lgabench {

/// The scenario's environment on that engine. @throws InputError for an environment that is not known.
std::unique_ptr<Environment> make_environment(const Scenario& scenario, std::unique_ptr<PhysicsWorld> world);

/// Scene `index` to demonstrate. Where the scenario leaves it to the method, targets are drawn from `selections`, one a
/// command; empty: the truth. @throws as EnvironmentType::sample().
Scene training_scene(const Scenario& scenario, const std::string& layout, const std::vector<Selection>& selections,
                     std::uint64_t training_seed, int index);

/// Test scene `index` of an arm, whatever was selected or trained on; with a training seed its own, else shared by all.
Scene test_scene(const Scenario& scenario, const std::string& layout, const std::string& arm, std::uint64_t scene_seed,
                 int index, std::optional<std::uint64_t> training_seed = std::nullopt);

}  // namespace lgabench
