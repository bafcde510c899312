#include <common/scene_members.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/contains.hpp>

namespace lgabench::common {
namespace {

// A list of the space's names, none of which any of the scenario's commands means.
std::vector<std::string> read_missing(const JsonReader& list, const std::vector<std::string>& space,
                                      const Scenario& scenario, std::vector<std::string> FeatureSet::*meant) {
  std::vector<std::string> names = list.strings();
  if (names.empty()) list.fail("at least one name");
  for (const JsonReader& name : list.elements()) {
    if (!lgabench::contains(space, name.string())) name.fail("a name of the feature space");
    if (std::count(names.begin(), names.end(), name.string()) > 1) name.fail("each name once");
    for (const ScenarioCommand& command : scenario.commands)
      if (lgabench::contains(command.truth.target.product().*meant, name.string()))
        name.fail(fmt::format("a name outside of what \"{}\" means", command.utterance));
  }
  return names;
}

}  // namespace

NearMiss read_near_miss(const JsonReader& reader, const Scenario& scenario) {
  NearMiss sets;
  if (reader.json() == Json(true)) return sets;
  if (!reader.json().is_object()) reader.fail("true, or an object");
  reader.only({"object_types", "textures", "alike", "size"});
  if (reader.has("size")) {
    sets.size_matched = reader.at("size").string() == "matched";
    if (!sets.size_matched) reader.at("size").fail("\"matched\"");
  }
  if (reader.has("alike") && !(sets.alike = reader.at("alike").boolean())) reader.at("alike").fail("true");
  if (sets.alike && reader.has("textures")) reader.at("textures").fail("no such member beside \"alike\"");
  if (reader.has("object_types"))
    sets.object_types =
        read_missing(reader.at("object_types"), scenario.space.object_types, scenario, &FeatureSet::object_types);
  if (reader.has("textures"))
    sets.textures = read_missing(reader.at("textures"), scenario.space.textures, scenario, &FeatureSet::textures);
  return sets;
}

std::pair<int, int> read_distractors(const JsonReader& reader, int most) {
  const auto range = reader.elements();
  if (range.size() != 2) reader.fail("[fewest, most]");
  const int fewest = static_cast<int>(range[0].integer(0, most));
  return {fewest, static_cast<int>(range[1].integer(fewest, most))};
}

}  // namespace lgabench::common
