#include <lgabench/harness/demonstrations.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/harness/hdf5.hpp>

namespace lgabench {
namespace {

PlanarPose disturbed(const PlanarPose& pose, double sigma, RandomStream& stream) {
  const double dx = .25 * sigma * stream.gaussian(), dy = .5 * sigma * stream.gaussian();
  const double yaw_rad = pi * sigma * stream.gaussian();
  return {pose.position_m + Vec2{dx, dy}, from_yaw(yaw_rad) * pose.rotation};
}

// As it is after a file: fresh and cached demonstrations must train the same policy.
Action label(const Action& action) { return from_vector(to_vector(action)); }

// The state that a noisy execution of the oracle's action leads to, labelled; false where it is to be dropped.
bool recovery_step(Environment& environment, const Scene& scene, double sigma, int k, Step& step) {
  RandomStream stream(fmt::format("dart/{}/{}", hex(scene.hash()), k));
  environment.reset(scene);
  Action action = environment.expert_action();
  action.pose0 = disturbed(action.pose0, sigma, stream);
  action.pose1 = disturbed(action.pose1, sigma, stream);
  StepResult result = environment.step(action);
  if (result.truncated || result.failure == Failure::left_workspace || result.failure == Failure::touched_obstacle)
    return false;
  step = {std::move(result.observation), label(environment.expert_action())};
  return true;
}

// Named by everything that decides its bytes; a scene's hash covers scenario, layout, features, seed and index.
fs::path cache_file(const DemonstrationCache& cache, const std::vector<Scene>& scenes, const Needs& needs,
                    const std::vector<std::string>& utterances) {
  std::vector<std::string> hashes;
  for (const Scene& scene : scenes) hashes.push_back(hex(scene.hash()));
  const Json identity{{"builds", cache.builds},
                      {"environment", cache.environment_id},
                      {"noisy_per_clean", needs.noisy_per_clean},
                      {"noise_max", needs.noise_max},
                      {"scenes", hashes},
                      {"utterances", utterances}};
  return cache.directory / (sha256(canonical(identity)).substr(0, 32) + ".hdf5");
}

}  // namespace

std::vector<Demonstration> demonstrate(Environment& environment, const std::vector<Scene>& scenes, const Needs& needs,
                                       const std::vector<std::string>& utterances) {
  std::vector<Demonstration> all;
  for (const Scene& scene : scenes) {
    Demonstration demonstration;
    demonstration.instruction.utterance = utterances.at(static_cast<std::size_t>(scene.command));
    Observation observation = environment.reset(scene);
    demonstration.steps.push_back({std::move(observation), label(environment.expert_action())});
    for (int k = 1; k <= needs.noisy_per_clean; ++k) {
      Step step;
      if (recovery_step(environment, scene, needs.noise_max * k / needs.noisy_per_clean, k, step))
        demonstration.steps.push_back(std::move(step));
    }
    all.push_back(std::move(demonstration));
  }
  return all;
}

std::vector<Demonstration> cached_demonstrations(const DemonstrationCache& cache, Environment& environment,
                                                 const std::vector<Scene>& scenes, const Needs& needs,
                                                 const std::vector<std::string>& utterances,
                                                 const std::function<void(int)>& done) {
  constexpr std::size_t per_file = 10;
  std::vector<Demonstration> all;
  for (std::size_t first = 0; first < scenes.size(); first += per_file) {
    const auto begin = scenes.begin() + static_cast<std::ptrdiff_t>(first);
    const auto count = static_cast<std::ptrdiff_t>(std::min(per_file, scenes.size() - first));
    const std::vector<Scene> block(begin, begin + count);
    const fs::path file = cache_file(cache, block, needs, utterances);
    std::vector<Demonstration> demonstrations;
    try {
      if (fs::exists(file)) demonstrations = read_demonstrations(file);
    } catch (const InputError& e) {
      fmt::print(stderr, "{}; made again\n", e.what());
    }
    if (demonstrations.size() != block.size()) {
      demonstrations = demonstrate(environment, block, needs, utterances);
      write_file(file, demonstrations_hdf5(demonstrations, cache.environment_id));
    }
    std::move(demonstrations.begin(), demonstrations.end(), std::back_inserter(all));
    done(static_cast<int>(all.size()));
  }
  return all;
}

}  // namespace lgabench
