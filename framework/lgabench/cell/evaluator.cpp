#include <lgabench/cell/evaluator.hpp>

#include <fmt/format.h>

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
  for (int step = 0;; ++step) {
    if (test.perception) observation = test.perception(observation, scene, step);  // a plugin's fault is no method's
    try {
      const Move move = actor.act(environment, scene, observation, step);
      StepResult result = environment.step(move.action);  // refuses one that is not executable()
      episode.failure = result.failure;
      if (episode.taken == 0) episode.taken = result.taken;
      episode.add(move.action.empty() ? Action() : as_stored(environment.action_space(), move.action));
      episode.input_seen = step == 0 || move.input_seen == false ? move.input_seen : episode.input_seen;
      if (environment.most_steps() == 1 || result.terminated || result.truncated) return episode;
      observation = std::move(result.observation);
    } catch (const MethodError& e) {
      const std::string at = environment.most_steps() == 1 ? "" : fmt::format(", step {}", step + 1);
      to_stderr("episode {} of {}{}: {}\n", scene.index, scene.arm, at, e.what());
      episode.failure = failure::method_error;
      episode.error = e.what();
      return episode;
    }
  }
}

Actor::Told told_by_command(const std::vector<Instruction>& instructions) {
  return [&instructions](const Scene& scene) { return instructions.at(static_cast<std::size_t>(scene.command)); };
}

}  // namespace

Move Actor::act(const Environment& environment, const Scene& scene, const Observation& seen, int step) const {
  Given given{scene, seen};
  given.step = step;
  if (told) given.told = told(scene);
  if (reads) given.read = reads(seen, scene);
  if (recorder) recorder->given(environment, given);
  const Move move = choose(environment, given);
  if (recorder) recorder->acted();
  return move;
}

Actor policy_actor(Policy& policy, Actor::Told told, const std::string& plugin_id) {
  const auto choose = [&policy, plugin_id](const Environment&, const Given& given) {
    try {
      return guarded(plugin_id, [&] {
        if (given.step == 0) policy.reset();
        const Action action = policy.act(given.observation(), given.told.value());
        return Move(action, policy.seen_in_training());
      });
    } catch (const InputError& e) {  // at this point only the method can be at fault
      throw MethodError(e.what());
    }
  };
  return {choose, std::move(told)};
}

Actor policy_actor(Policy& policy, const std::vector<Instruction>& instructions, const std::string& plugin_id) {
  return policy_actor(policy, told_by_command(instructions), plugin_id);
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

void attribute_failures(Environment& environment, const std::vector<TestScene>& scenes, Actor actor,
                        const std::vector<Instruction>& truth, std::vector<Episode>& episodes) {
  const auto succeeds = [&environment](const TestScene& test, const Actor& acts) {
    return play(environment, test, acts).success();
  };
  actor.recorder = nullptr;
  Actor unread = actor;
  unread.reads = nullptr;
  Actor with_truth = unread;
  with_truth.told = told_by_command(truth);
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    Episode& episode = episodes[i];
    if (episode.success()) continue;
    TestScene as_it_is = scenes.at(i);
    const bool errs = std::exchange(as_it_is.perception, nullptr) != nullptr || as_it_is.view != View();
    as_it_is.view = View();
    if (episode.failure == failure::abstraction_empty)
      episode.attribution = "abstraction";
    else if (actor.reads && succeeds(scenes[i], unread))
      episode.attribution = "reading";
    else if (errs && succeeds(as_it_is, actor))
      episode.attribution = "perception";
    else
      episode.attribution = succeeds(as_it_is, with_truth) ? "abstraction" : "policy";
  }
}

}  // namespace lgabench
