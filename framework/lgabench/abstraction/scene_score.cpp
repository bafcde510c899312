#include <lgabench/abstraction/scene_score.hpp>

#include <algorithm>
#include <vector>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>

namespace lgabench {
namespace {

std::vector<FeatureSet> undecided_of(const Scenario& scenario) {
  std::vector<FeatureSet> sets;
  const JsonReader file(scenario.json, scenario.id);
  if (file.has("undecided"))
    for (const JsonReader& set : file.at("undecided").elements()) sets.push_back(read_feature_set(set, scenario.space));
  return sets;
}

// The same turns, but for their sets.
bool are_alike(const Turn& a, const Turn& b) {
  const auto same_parts = [](const std::vector<Part>& some, const std::vector<Part>& others) {
    return std::is_permutation(some.begin(), some.end(), others.begin(), others.end());
  };
  return a.take == b.take && a.only_if_nothing == b.only_if_nothing && same_parts(a.same, b.same) &&
         same_parts(a.different, b.different);
}

Meaning sets_of(const Turn& turn) {
  Meaning meaning;
  meaning.sets = turn.sets;
  return meaning;
}

bool has_exact_sets(const Scenario& scenario, const Meaning& selected, const Meaning& truth) {
  if (selected.turns.size() != truth.turns.size()) return false;
  for (std::size_t i = 0; i < truth.turns.size(); ++i)
    if (!are_alike(selected.turns[i], truth.turns[i]) ||
        !has_exact_sets(scenario, sets_of(selected.turns[i]), sets_of(truth.turns[i])))
      return false;
  const std::vector<FeatureSet> undecided = undecided_of(scenario);
  for (const std::string& type : scenario.space.object_types)
    for (const std::string& texture : scenario.space.textures) {
      const auto holds = [&](const FeatureSet& set) { return set.contains(type, texture); };
      const bool open = is_place(type) || std::any_of(undecided.begin(), undecided.end(), holds);
      if (!open && selected.belongs(type, texture) != truth.belongs(type, texture)) return false;
    }
  return true;
}

}  // namespace

void add_scene(const Scene& scene, const Observation& seen, const std::vector<std::uint8_t>& kept, bool astray,
               SceneScore& score) {
  bool exact = !astray;
  const std::vector<bool> meant = meant_at_first(scene);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const auto instance = std::find_if(seen.instances.begin(), seen.instances.end(),
                                       [&](const Instance& one) { return one.id == object.instance_id; });
    if (instance == seen.instances.end() || instance->pixels == 0) continue;
    const bool is_kept = contains(kept, object.instance_id);
    const bool is_meant = meant[i];
    score.kept += is_kept;
    score.meant += is_meant;
    score.right += is_kept && is_meant;
    if (is_kept == is_meant) continue;
    exact = false;
    (is_kept ? score.wrongly_kept : score.missed).insert(object.object_type);
  }
  ++score.scenes;
  score.exact_scenes += exact;
}

SceneScore& operator+=(SceneScore& all, const SceneScore& more) {
  for (const auto member : {&SceneScore::commands, &SceneScore::exact_sets, &SceneScore::scenes,
                            &SceneScore::exact_scenes, &SceneScore::kept, &SceneScore::meant, &SceneScore::right})
    all.*member += more.*member;
  all.wrongly_kept.insert(more.wrongly_kept.begin(), more.wrongly_kept.end());
  all.missed.insert(more.missed.begin(), more.missed.end());
  return all;
}

SceneScore score(const Scenario& scenario, int command, const Selection& selection, const std::string& layout,
                 std::uint64_t scene_seed, int scenes) {
  SceneScore score;
  score.commands = 1;
  score.exact_sets =
      has_exact_sets(scenario, selection.target, scenario.commands[static_cast<std::size_t>(command)].truth.target);
  const EnvironmentType& environment = *scenario.environment;
  for (const Arm& arm : scenario.tests) {
    const std::vector<int> commands = scenario.commands_of(arm.id);
    const auto turn = std::find(commands.begin(), commands.end(), command);
    if (turn == commands.end()) continue;
    const Perception perceived = perception_of(scenario, arm);
    for (int i = 0; i < scenes; ++i) {
      const int index = static_cast<int>(turn - commands.begin()) + i * static_cast<int>(commands.size());
      const Scene scene = test_scene(scenario, layout, arm.id, scene_seed, index);
      const Observation drawn = environment.draw(scene, view_of(scenario, scene)),
                        seen = perceived ? perceived(drawn, scene, 0) : drawn;
      add_scene(scene, seen, grounded(selection.target, seen), false, score);
    }
  }
  return score;
}

void add_source(const std::string& source, std::vector<std::string>& all) {
  all.erase(std::remove(all.begin(), all.end(), source), all.end());
  all.push_back(source);
}

bool covers_truth(const std::vector<Hypothesis>& hypotheses, const Scenario& scenario, int command) {
  const Meaning& truth = scenario.commands[static_cast<std::size_t>(command)].truth.target;
  return std::any_of(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& one) {
    return one.meaning.which == truth.which && has_exact_sets(scenario, one.meaning, truth);
  });
}

}  // namespace lgabench
