#include <lgabench/cell/evaluator.hpp>

#include <utility>

#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

Episode play(Environment& environment, const TestScene& test, const Actor& actor) {
  const Scene& scene = test.scene;
  Episode episode{scene.arm, scene.index, scene.command, hex(scene.hash()), failure::abstraction_empty};
  if (test.abstraction_empty) return episode;
  Observation observation = environment.reset(scene);
  if (test.view != View()) observation = environment.look(test.view);
  if (test.perception) observation = test.perception(observation, scene);
  try {
    const Move move = actor(environment, scene, observation);
    const StepResult result = environment.step(move.action);  // refuses one that is not executable()
    episode.failure = result.failure;
    episode.taken = result.taken;
    episode.action = as_stored(environment.action_space(), move.action);
    episode.input_seen = move.input_seen;
  } catch (const MethodError& e) {
    to_stderr("episode {} of {}: {}\n", scene.index, scene.arm, e.what());
    episode.failure = failure::method_error;
    episode.error = e.what();
  }
  return episode;
}

// `told(scene)` is an Instruction, or a reference to one.
template <class Told>
Actor acting(Policy& policy, Told told, const std::string& plugin_id) {
  return [&policy, told = std::move(told), plugin_id](const Environment&, const Scene& scene,
                                                      const Observation& observation) {
    try {
      return guarded(plugin_id, [&] {
        policy.reset();
        const Action action = policy.act(observation, told(scene));
        return Move(action, policy.seen_in_training());
      });
    } catch (const InputError& e) {  // at this point only the method can be at fault
      throw MethodError(e.what());
    }
  };
}

}  // namespace

Actor policy_actor(Policy& policy, const std::vector<Instruction>& instructions, const std::string& plugin_id) {
  const auto told = [&instructions](const Scene& scene) -> const Instruction& {
    return instructions.at(static_cast<std::size_t>(scene.command));
  };
  return acting(policy, told, plugin_id);
}

Actor policy_actor(Policy& policy, std::function<Instruction(const Scene&)> told, const std::string& plugin_id) {
  return acting(policy, std::move(told), plugin_id);
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

Actor reading_actor(Perception reading, Actor actor) {
  if (!reading) return actor;
  return [reading = std::move(reading), actor = std::move(actor)](const Environment& environment, const Scene& scene,
                                                                  const Observation& seen) {
    return actor(environment, scene, reading(seen, scene));
  };
}

void attribute_failures(Environment& environment, const std::vector<TestScene>& scenes, const Actor& actor,
                        const Actor& with_truth, std::vector<Episode>& episodes, const Actor& unread) {
  const auto succeeds = [&environment](const TestScene& test, const Actor& acts) {
    return play(environment, test, acts).success();
  };
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    Episode& episode = episodes[i];
    if (episode.success()) continue;
    TestScene as_it_is = scenes.at(i);
    const bool errs = std::exchange(as_it_is.perception, nullptr) != nullptr || as_it_is.view != View();
    as_it_is.view = View();
    if (episode.failure == failure::abstraction_empty)
      episode.attribution = "abstraction";
    else if (unread && succeeds(scenes[i], unread))
      episode.attribution = "reading";
    else if (errs && succeeds(as_it_is, actor))
      episode.attribution = "perception";
    else
      episode.attribution = succeeds(as_it_is, with_truth) ? "abstraction" : "policy";
  }
}

}  // namespace lgabench
