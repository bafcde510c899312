#include <lgabench/abstraction/disputed.hpp>

#include <algorithm>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>

namespace lgabench {

DisputedPairs disputed_pairs(const FeatureSpace& space) {
  const fs::path file = data_directory() / "disputed" / (space.id + ".json");
  return fs::exists(file) ? read_disputed(file, space) : DisputedPairs();
}

DisputedPairs read_disputed(const fs::path& file, const FeatureSpace& space) {
  const Json json = read_json(file);
  const JsonReader reader(json, file.string());
  reader.only({"dated", "rule", "how", "commands"});
  for (const char* words : {"dated", "rule", "how"}) reader.at(words).string();
  DisputedPairs all;
  for (const JsonReader& one : reader.at("commands").elements()) {
    one.only({"command", "pairs", "why"});
    one.at("why").string();
    std::vector<FeatureSet> sets;
    for (const JsonReader& set : one.at("pairs").elements()) sets.push_back(read_feature_set(set, space));
    if (sets.empty()) one.at("pairs").fail("at least one");
    if (!all.emplace(one.at("command").string(), std::move(sets)).second) one.fail("each command once");
  }
  return all;
}

bool is_disputed(const DisputedPairs& pairs, const Scenario& scenario, const Scene& scene) {
  const auto found = pairs.find(scenario.commands[static_cast<std::size_t>(scene.command)].utterance);
  if (found == pairs.end()) return false;
  std::vector<std::uint8_t> ids;
  for (const SceneObject& object : scene.objects)
    if (!is_place(object.object_type) && !(scenario.second && object.role == scenario.second->id) &&
        any_contains(found->second, object.object_type, object.texture))
      ids.push_back(object.instance_id);
  if (ids.empty()) return false;
  const Observation seen = scenario.environment->draw(scene, view_of(scenario, scene));
  return std::any_of(seen.instances.begin(), seen.instances.end(),
                     [&](const Instance& one) { return one.pixels > 0 && contains(ids, one.id); });
}

}  // namespace lgabench
