#include <lgabench/cell/evaluator.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include <lgabench/core/hash.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

Action oracle(const Environment& environment, const Scene&, const Observation&) { return environment.expert_action(); }

using Instances = std::vector<Instance>;

// What can be seen and taken.
Instances visible(const Scene& scene, const Observation& observation) {
  const SceneObject* goal = scene.find(role::goal);
  Instances all;
  for (const Instance& instance : observation.instances)
    if (instance.pixels > 0 && !(goal && instance.id == goal->instance_id)) all.push_back(instance);
  if (all.empty()) throw MethodError("no object is visible");
  return all;
}

// Handles one of them, drawn from the row's stream, as the oracle would.
Action any_of(const Instances& some, const char* row, const Environment& environment, const Scene& scene) {
  RandomStream stream(fmt::format("{}/{}", row, hex(scene.hash())));
  return environment.expert_action_for(some[stream.below(static_cast<std::uint32_t>(some.size()))].id);
}

Action random_object(const Environment& environment, const Scene& scene, const Observation& observation) {
  return any_of(visible(scene, observation), "random_object", environment, scene);
}

Action most_shared(const Environment& environment, const Scene& scene, const Observation& observation) {
  const Instances all = visible(scene, observation);
  int most = 0;
  Instances some;
  for (const Instance& one : all) {
    int shared = 0;
    for (const Instance& other : all) shared += (other.object_type == one.object_type) + (other.texture == one.texture);
    if (shared > most) some.clear();
    if (shared >= most) some.push_back(one);
    most = std::max(most, shared);
  }
  return any_of(some, "most_shared", environment, scene);
}

using Pairs = std::set<std::pair<std::string, std::string>>;  // of types and textures

Actor never_demonstrated(const std::vector<Scene>& demonstrated) {
  Pairs shown;
  for (const Scene& scene : demonstrated)
    for (const SceneObject& o : scene.objects)
      if (o.role == role::target) shown.emplace(o.object_type, o.texture);
  return [shown](const Environment& environment, const Scene& scene, const Observation& observation) {
    const Instances all = visible(scene, observation);
    Instances some;
    std::copy_if(all.begin(), all.end(), std::back_inserter(some), [&shown](const Instance& one) {
      return shown.count({one.object_type, one.texture}) == 0;
    });
    return Move(any_of(some.empty() ? all : some, "never_demonstrated", environment, scene));
  };
}

Episode play(Environment& environment, const TestScene& test, const Actor& actor) {
  const Scene& scene = test.scene;
  Episode episode{scene.arm, scene.index, scene.command, hex(scene.hash()), failure::abstraction_empty};
  if (test.abstraction_empty) return episode;
  Observation observation = environment.reset(scene);
  if (test.view != View()) observation = environment.look(test.view);
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

Actor reference_actor(const std::string& id, const std::vector<Scene>& demonstrated) {
  if (id == "oracle") return oracle;
  if (id == "random_object") return random_object;
  if (id == "most_shared") return most_shared;
  if (id == "never_demonstrated") return never_demonstrated(demonstrated);
  throw InputError(
      fmt::format("reference row \"{}\": expected constant_action, random_object, oracle, most_shared or "
                  "never_demonstrated",
                  id));
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
    const bool errs = std::exchange(as_it_is.perception, nullptr) != nullptr || as_it_is.view != View();
    as_it_is.view = View();
    if (episode.failure == failure::abstraction_empty)
      episode.attribution = "abstraction";
    else if (errs && succeeds(as_it_is, actor))
      episode.attribution = "perception";
    else
      episode.attribution = succeeds(as_it_is, with_truth) ? "abstraction" : "policy";
  }
}

}  // namespace lgabench
