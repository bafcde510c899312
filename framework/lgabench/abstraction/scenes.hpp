// Scenes of a scenario as a run plays them and as a method sees them: for the harness, and for programs of one's own.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/physics_world.hpp>
#include <lgabench/core/scenario.hpp>

namespace lgabench {

/// The scenario's environment on that engine. Calls out of order (see Environment), such as a step after the end of an
/// episode of several, @throw Error, after which calls in order work. In tasks of several steps actions are carried out
/// as_stored(), and the last of most_steps() ends the episode. What the environment does against its interface is an
/// EngineError that names scene and step. @throws InputError for an environment that is not known.
std::unique_ptr<Environment> make_environment(const Scenario& scenario, std::unique_ptr<PhysicsWorld> world);

/// Scene `index` to demonstrate. Where the scenario leaves it to the method, targets are drawn from `selections`, one a
/// command; empty: the truth. @throws as EnvironmentType::sample().
Scene training_scene(const Scenario& scenario, const std::string& layout, const std::vector<Selection>& selections,
                     std::uint64_t training_seed, int index);

/// Scene `index` of the request, changed by the arm's perturbation where it is a test scene. @throws as
/// EnvironmentType::sample() and perturbed().
Scene sampled_scene(const Scenario& scenario, const SceneRequest& request, int index);

/// Test scene `index` of an arm, whatever was selected or trained on; with a training seed its own, else shared by all.
Scene test_scene(const Scenario& scenario, const std::string& layout, const std::string& arm, std::uint64_t scene_seed,
                 int index, std::optional<std::uint64_t> training_seed = std::nullopt);

/// What a policy is given in place of what the environment shows after so many steps of the scene.
using Perception = std::function<Observation(const Observation& seen, const Scene& scene, int step)>;

/// A test scene, and how it is seen.
struct TestScene {
  Scene scene;
  Perception perception = nullptr;  // null: as it is
  bool abstraction_empty = false;   // nothing was selected for its command: failed without being played
  View view = {};
};

/// The arm's: its noise, and what the environment adds (EnvironmentType::perception()); null where neither errs. Draws
/// from a stream of the scene and the step in which the arm has no part: more noise adds errors to those that less of
/// it makes. `training_seed`: as in SceneRequest. @pre the scenario outlives it.
Perception perception_of(const Scenario& scenario, const Arm& arm,
                         std::optional<std::uint64_t> training_seed = std::nullopt);

/// How the scene's arm is looked at: the usual view, but for a perturbation. `training_seed`: as in SceneRequest.
View view_of(const Scenario& scenario, const Scene& scene, std::optional<std::uint64_t> training_seed = std::nullopt);

/// The test scene with its arm's perception and view. `training_seed`: as in SceneRequest. @pre the scenario outlives
/// it.
TestScene in_its_arm(const Scenario& scenario, Scene scene, std::optional<std::uint64_t> training_seed);

}  // namespace lgabench
