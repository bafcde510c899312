#include <lgabench/cell/demonstrations.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include <lgabench/cell/hdf5.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench {
namespace {

// Turned by an angle about z, or by that angle.
void turn(Action& action, const std::vector<std::size_t>& rotation, double by_rad) {
  if (rotation.size() == 4) {
    const Quat q =
        from_yaw(by_rad) * Quat{action[rotation[0]], action[rotation[1]], action[rotation[2]], action[rotation[3]]};
    action[rotation[0]] = q.x;
    action[rotation[1]] = q.y;
    action[rotation[2]] = q.z;
    action[rotation[3]] = q.w;
  } else {
    const Vec2 turned = rotated(Vec2{action[rotation[0]], action[rotation[1]]}, by_rad);
    action[rotation[0]] = turned.x;
    action[rotation[1]] = turned.y;
  }
}

// Number by number: sigma 1 is half of a number's range, and half a turn.
Action disturbed(const ActionSpace& space, Action action, double sigma, RandomStream& stream) {
  for (std::size_t i = 0; i < action.size(); ++i) {
    const auto rotation = std::find_if(space.rotations.begin(), space.rotations.end(),
                                       [&](const auto& rotation_of) { return contains(rotation_of, i); });
    if (rotation == space.rotations.end())
      action[i] += (space.numbers[i].high - space.numbers[i].low) / 2 * sigma * stream.gaussian();
    else if (rotation->front() == i)
      turn(action, *rotation, pi * sigma * stream.gaussian());
  }
  return action;
}

// Rounded as the file rounds it, so that fresh and cached demonstrations train the same policy.
Action label(const Environment& environment) {
  const Action action = environment.expert_action();
  return action.empty() ? action : as_stored(environment.action_space(), action);
}

bool is_over(const StepResult& result) { return result.terminated || result.truncated; }

// The oracle's. Its only action is carried out where somebody wants to know what it leads to.
std::vector<Step> episode(Environment& environment, const Scene& scene, std::vector<StepResult>* results) {
  std::vector<Step> steps;
  Observation observation = environment.reset(scene);
  for (;;) {
    steps.push_back({std::move(observation), label(environment)});
    const bool is_only = environment.most_steps() == 1;
    if (is_only && !results) return steps;
    StepResult result = environment.step(steps.back().label);
    if (!is_only && is_over(result) && !result.is_success)
      throw EngineError(fmt::format("scene {} of {}, step {}: the oracle's episode {}", scene.index, scene.arm,
                                    steps.size(),
                                    result.failure == failure::goes_on ? "does not end" : "ends as " + result.failure));
    const bool was_last = is_only || is_over(result);
    observation = was_last ? Observation() : result.observation;
    if (results) results->push_back(std::move(result));
    if (was_last) return steps;
  }
}

// The state that a noisy execution of the oracle's action leads to, labelled; false where it is to be dropped.
bool recovery_step(Environment& environment, const Scene& scene, double sigma, int k, Step& step) {
  RandomStream stream(fmt::format("dart/{}/{}", hex(scene.hash()), k));
  environment.reset(scene);
  const Action action = disturbed(environment.action_space(), environment.expert_action(), sigma, stream);
  StepResult result = environment.step(action);
  if (!result.recoverable || (environment.most_steps() > 1 && is_over(result))) return false;
  step = {std::move(result.observation), label(environment)};
  return true;
}

// All that decides a file's bytes; a scene's hash covers scenario, layout, features, seed and index.
Json identity(const DemonstrationCache& cache, const std::vector<Scene>& scenes, const Needs& needs,
              const std::vector<std::string>& utterances) {
  std::vector<std::string> hashes;
  for (const Scene& scene : scenes) hashes.push_back(hex(scene.hash()));
  Json all{{"builds", cache.builds},
           {"environment", cache.environment_id},
           {"labels", {{"noisy_per_clean", needs.noisy_per_clean}, {"noise_max", needs.noise_max}}},
           {"scenes", hashes},
           {"utterances", utterances}};
  if (needs.shadows) all["shadows"] = true;
  return all;
}

// After the HDF5 file's own bytes comes a line that says what they are: the identity and their SHA-256.
std::string sealed(const std::string& hdf5, const Json& made_from) {
  return hdf5 + '\n' + canonical({{"made_from", made_from}, {"sha256", sha256(hdf5)}}) + '\n';
}

// What it holds, if it is what `made_from` says and as it was written. @throws InputError
std::vector<Demonstration> read_sealed(const fs::path& file, const Json& made_from) {
  std::string bytes = read_file(file);
  const std::size_t seal = bytes.size() < 2 ? bytes.npos : bytes.rfind('\n', bytes.size() - 2);
  const Json said = seal == bytes.npos ? Json() : json_or_null(std::string_view(bytes).substr(seal + 1));
  if (!said.is_object() || !said.contains("made_from") || !said.contains("sha256"))
    throw InputError(file.string() + ": expected a last line with its description: cut off, or of an older version");
  if (said.at("made_from") != made_from)
    throw InputError(file.string() + ": holds other scenes or labels than its name says");
  bytes.resize(seal);
  if (said.at("sha256") != sha256(bytes)) throw InputError(file.string() + ": changed since it was written");
  return read_demonstrations(std::move(bytes), file.string());
}

}  // namespace

std::vector<Demonstration> demonstrate(Environment& environment, const std::vector<Scene>& scenes, const Needs& needs,
                                       const std::vector<std::string>& utterances, Outcomes* outcomes) {
  std::vector<Demonstration> all;
  for (const Scene& scene : scenes) {
    std::vector<StepResult> results;
    Demonstration demonstration;
    demonstration.instruction.utterance = utterances.at(static_cast<std::size_t>(scene.command));
    demonstration.steps = episode(environment, scene, outcomes ? &results : nullptr);
    for (int k = 1; k <= needs.noisy_per_clean; ++k) {
      Step step;
      if (!recovery_step(environment, scene, needs.noise_max * k / needs.noisy_per_clean, k, step)) continue;
      if (outcomes) results.push_back(environment.step(step.label));
      demonstration.recovery.push_back(std::move(step));
    }
    all.push_back(std::move(demonstration));
    if (outcomes) outcomes->push_back(std::move(results));
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
    const Json made_from = identity(cache, block, needs, utterances);
    const fs::path file = cache.directory / (sha256(canonical(made_from)).substr(0, 32) + ".hdf5");
    std::vector<Demonstration> demonstrations;
    try {
      if (fs::exists(fs::symlink_status(file))) demonstrations = read_sealed(file, made_from);
    } catch (const InputError& e) {
      to_stderr("{}; made again\n", e.what());
    }
    if (demonstrations.size() != block.size()) {
      demonstrations = demonstrate(environment, block, needs, utterances);
      try {
        write_file(file, sealed(demonstrations_hdf5(demonstrations, cache.environment_id), made_from));
      } catch (const InputError& e) {  // full, read-only, or cleared at this moment: that costs time, and no cell
        to_stderr("{}; not kept\n", e.what());
      }
    }
    std::move(demonstrations.begin(), demonstrations.end(), std::back_inserter(all));
    done(static_cast<int>(all.size()));
  }
  return all;
}

}  // namespace lgabench
