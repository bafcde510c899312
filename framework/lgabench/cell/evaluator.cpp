#include <lgabench/cell/evaluator.hpp>

#include <fmt/format.h>

#include <utility>

#include <lgabench/abstraction/textualization.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

Action oracle(const Environment& environment, const Scene&, const Observation&) { return environment.expert_action(); }

Action random_object(const Environment& environment, const Scene& scene, const Observation& observation) {
  const SceneObject* goal = scene.find(role::goal);
  std::vector<std::uint8_t> visible;
  for (const Instance& instance : observation.instances)
    if (instance.pixels > 0 && !(goal && instance.id == goal->instance_id)) visible.push_back(instance.id);
  if (visible.empty()) throw MethodError("no object is visible");
  RandomStream stream("random_object/" + hex(scene.hash()));
  return environment.expert_action_for(visible[stream.below(static_cast<std::uint32_t>(visible.size()))]);
}

Episode play(Environment& environment, const TestScene& test, const Actor& actor) {
  const Scene& scene = test.scene;
  Episode episode{scene.arm, scene.index, scene.command, hex(scene.hash()), failure::abstraction_empty};
  if (test.abstraction_empty) return episode;
  Observation observation = environment.reset(scene);
  if (test.perception) observation = test.perception(observation, scene);
  try {
    const Move move = actor(environment, scene, observation);
    episode.failure = environment.step(move.action).failure;  // refuses one that is not executable()
    episode.action = as_stored(environment.action_space(), move.action);
    episode.input_seen = move.input_seen;
  } catch (const MethodError& e) {
    to_stderr("episode {} of {}: {}\n", scene.index, scene.arm, e.what());
    episode.failure = failure::method_error;
    episode.error = e.what();
  }
  return episode;
}

}  // namespace

Perception perception_of(const Scenario& scenario, const Arm& arm, std::optional<std::uint64_t> training_seed) {
  const TextualizationNoise noise{arm.label_noise, arm.missed_segment};
  const Perceive perceive = find_environment(scenario.environment).perception(*arm.scenes);
  if (!perceive && noise.label_noise == 0 && noise.missed_segment == 0) return nullptr;
  const std::string own = own_stream(training_seed);
  return [&scenario, noise, perceive, own](const Observation& seen, const Scene& scene) {
    const auto stream = [&](const char* of) {
      return RandomStream(
          fmt::format("{}/{}/{}/{}{}/{}", of, scene.scenario, scene.layout, scene.seed, own, scene.index));
    };
    return imperfect_textualization(perceive ? perceive(seen, stream("perception")) : seen, scenario.space, noise,
                                    stream("textualization"));
  };
}

Actor policy_actor(Policy& policy, const std::vector<Instruction>& instructions, const std::string& plugin_id) {
  return [&policy, &instructions, plugin_id](const Environment&, const Scene& scene, const Observation& observation) {
    try {
      return guarded(plugin_id, [&] {
        policy.reset();
        const Action action = policy.act(observation, instructions.at(static_cast<std::size_t>(scene.command)));
        return Move(action, policy.seen_in_training());
      });
    } catch (const InputError& e) {  // at this point only the method can be at fault
      throw MethodError(e.what());
    }
  };
}

Actor reference_actor(const std::string& id) {
  if (id == "oracle") return oracle;
  if (id == "random_object") return random_object;
  throw InputError(fmt::format("reference row \"{}\": expected constant_action, random_object or oracle", id));
}

std::vector<Episode> evaluate(Environment& environment, const std::vector<TestScene>& scenes, const Actor& actor,
                              const std::function<void(int)>& done) {
  std::vector<Episode> episodes;
  episodes.reserve(scenes.size());
  for (const TestScene& test : scenes) {
    episodes.push_back(play(environment, test, actor));
    done(static_cast<int>(episodes.size()));
  }
  return episodes;
}

void attribute_failures(Environment& environment, const std::vector<TestScene>& scenes, const Actor& actor,
                        const Actor& with_truth, std::vector<Episode>& episodes) {
  const auto succeeds = [&environment](const TestScene& test, const Actor& acts) {
    return play(environment, test, acts).success();
  };
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    Episode& episode = episodes[i];
    if (episode.success()) continue;
    TestScene as_it_is = scenes.at(i);
    const bool errs = std::exchange(as_it_is.perception, nullptr) != nullptr;
    if (episode.failure == failure::abstraction_empty)
      episode.attribution = "abstraction";
    else if (errs && succeeds(as_it_is, actor))
      episode.attribution = "perception";
    else
      episode.attribution = succeeds(as_it_is, with_truth) ? "abstraction" : "policy";
  }
}

}  // namespace lgabench
