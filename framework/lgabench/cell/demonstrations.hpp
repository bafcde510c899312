// The oracle's demonstrations, with DART's recovery steps where a method asks for them, and their cache.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/method.hpp>

namespace lgabench {

/// What the label of each step leads to, for each demonstration: of its episode, then of its recovery steps.
using Outcomes = std::vector<std::vector<StepResult>>;

/// One demonstration a scene: the oracle's episode to its end. With needs.noisy_per_clean = n > 0, recovery
/// (docs/protocol.md, section 5; DART: Laskey et al. 2017): rollout k of n resets the scene, executes the oracle's
/// first action with Gaussian noise of sigma = noise_max k / n (x std .25 sigma, y std .5 sigma, yaw std pi sigma, on
/// both poses), and the state that this led to is added with the oracle's action for it; its first step would be the
/// clean one again. A rollout that ended an episode of several steps, left the workspace, touched the obstacle or did
/// not come to rest is dropped. Labels are noiseless and have the precision of a file. A function of its arguments: the
/// noise is a random stream per scene and k. `utterances`: of the scenario's commands, as Scene::command counts them.
/// `outcomes`: filled if given; then every label is carried out.
/// @throws EngineError if the engine fails, or the oracle of a task of several steps fails or does not end its episode.
std::vector<Demonstration> demonstrate(Environment& environment, const std::vector<Scene>& scenes, const Needs& needs,
                                       const std::vector<std::string>& utterances, Outcomes* outcomes = nullptr);

/// Where finished demonstrations are kept, shared by methods, runs and processes.
struct DemonstrationCache {
  std::filesystem::path directory;
  Json builds;  // hashes of the programs and libraries that demonstrations depend on
  std::string environment_id;
};

/// demonstrate() through the cache: files of ten scenes each, named by the hash of all that they depend on, so that
/// demonstrations of the first ten scenes serve the first fifty too. Each says in a last line, after its HDF5, what it
/// was made from and the SHA-256 of the rest; a file that is not what its name and that line say is made again, which
/// is said on stderr, as is one that cannot be written. `done(n)` after each ten.
std::vector<Demonstration> cached_demonstrations(const DemonstrationCache& cache, Environment& environment,
                                                 const std::vector<Scene>& scenes, const Needs& needs,
                                                 const std::vector<std::string>& utterances,
                                                 const std::function<void(int)>& done);

}  // namespace lgabench
