#include <lgabench/cell/evaluator.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/core/turns.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

// An object's name in what an actor was given: of what covers most of the object there, whose name it has if nothing
// does.
Named name_given(const Instance& object, const Observation& seen, const Observation& given) {
  std::array<int, 256> common{};
  for (std::size_t i = 0; i < seen.ids.size(); ++i)
    if (seen.ids[i] == object.id) ++common[given.ids[i]];
  const Instance* best = nullptr;
  for (const Instance& one : given.instances)
    if (common[one.id] > (best ? common[best->id] : 0)) best = &one;
  return best ? Named{best->object_type, best->texture} : Named{object.object_type, object.texture};
}

// Notes what a step brought as the actor knew it: of what was seen and is no longer, that which has its name.
void note_brought(const Observation& seen, const Observation& given, const Observation& now,
                  std::vector<Named>& brought) {
  std::vector<Instance> gone;
  const auto is_there = [&now](const Instance& one) {
    return std::any_of(now.instances.begin(), now.instances.end(), [&](const Instance& o) { return o.id == one.id; });
  };
  std::copy_if(seen.instances.begin(), seen.instances.end(), std::back_inserter(gone),
               [&](const Instance& one) { return !is_there(one); });
  for (std::size_t i = brought.size(); i < now.brought.size(); ++i) {
    const Named& name = now.brought[i];
    const auto one = std::find_if(gone.begin(), gone.end(), [&](const Instance& o) {
      return Named{o.object_type, o.texture} == name;
    });
    brought.push_back(one == gone.end() ? name : name_given(*one, seen, given));
    if (one != gone.end()) gone.erase(one);
  }
}

// After a step: what it brought counts, and that it rightly said to be the last.
Progress progress_of(const Scene& scene, const Observation& before, const StepResult& result) {
  std::vector<Named> on_table;
  for (const Instance& one : before.instances) on_table.push_back({one.object_type, one.texture});
  const auto right = static_cast<int>(result.observation.brought.size()) + (result.is_success ? 1 : 0);
  const auto before_it = static_cast<int>(before.brought.size());
  return {right, std::max(before_it + takes_left(*scene.errand, on_table, before.brought) + 1,
                          result.is_success ? right : right + 1)};
}

Episode play(Environment& environment, const TestScene& test, const Actor& actor) {
  const Scene& scene = test.scene;
  Episode episode{scene.arm, scene.index, scene.command, hex(scene.hash()), failure::abstraction_empty};
  if (scene.pair) episode.pair = hex(scene.shared_hash());
  if (test.abstraction_empty) return episode;
  Observation observation = environment.reset(scene);
  if (test.view != View()) observation = environment.look(test.view);
  std::vector<Named> brought;  // as the actor was told it when it was taken
  for (int step = 0;; ++step) {
    // A plugin's fault is no method's.
    Observation perceived = test.perception ? test.perception(observation, scene, step) : observation;
    perceived.brought = brought;
    try {
      Observation given;
      const Move move =
          actor.act(environment, scene, perceived, step, environment.most_steps() == 1 ? nullptr : &given);
      StepResult result = environment.step(move.action);  // refuses one that is not executable()
      episode.failure = result.failure;
      if (scene.errand) episode.progress = progress_of(scene, observation, result);
      if (episode.taken == 0) episode.taken = result.taken;
      episode.add(move.action.empty() ? Action() : as_stored(environment.action_space(), move.action));
      episode.input_seen = step == 0 || move.input_seen == false ? move.input_seen : episode.input_seen;
      if (environment.most_steps() == 1 || result.terminated || result.truncated) return episode;
      note_brought(observation, given, result.observation, brought);
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

Move Actor::act(const Environment& environment, const Scene& scene, const Observation& seen, int step,
                Observation* saw) const {
  Given given{scene, seen};
  given.step = step;
  if (told) given.told = told(scene);
  if (reads) given.read = reads(seen, scene);
  if (recorder) recorder->given(environment, given);
  const Move move = choose(environment, given);
  if (recorder) recorder->acted();
  if (saw) *saw = given.observation();
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
