#include <lgabench/core/feature_space.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/read_space.hpp>
#include <lgabench/core/scenario_path.hpp>
#include <lgabench/core/shipped.hpp>
#include <lgabench/core/suggest.hpp>

namespace lgabench {
namespace {

std::vector<std::string> read_names(const JsonReader& reader, const std::vector<std::string>& space) {
  if (reader.json() == "ALL") return space;
  const bool except = reader.json().is_object();
  if (except) reader.only({"except"});
  std::vector<std::string> named;
  for (const JsonReader& element : (except ? reader.at("except") : reader).elements()) {
    const std::string name = element.string();
    if (!contains(space, name)) element.fail("a name of the feature space");
    if (contains(named, name)) element.fail("each name once");
    named.push_back(name);
  }
  std::vector<std::string> ordered;
  for (const std::string& name : space)
    if (contains(named, name) != except) ordered.push_back(name);
  return ordered;
}

std::vector<std::string> read_all_names(const JsonReader& list) {
  std::vector<std::string> names = list.strings(), once = names;
  std::sort(once.begin(), once.end());
  if (names.empty() || std::adjacent_find(once.begin(), once.end()) != once.end()) list.fail("names, each once");
  return names;
}

constexpr const char* tells_a_space = "object_types";

}  // namespace

std::vector<std::string> feature_space_ids() {
  std::vector<std::string> ids = shipped_names("spaces");
  for (const auto& own : files_on_scenario_path(tells_a_space))
    if (!contains(ids, own.first)) ids.push_back(own.first);
  return ids;
}

fs::path feature_space_file(const std::string& id) {
  if (contains(shipped_names("spaces"), id)) return data_directory() / "spaces" / (id + ".json");
  static MadeOnce<fs::path> own;  // else each scenario and each cell would read all files of the path
  return own.of(id, [&] {
    const auto files = files_on_scenario_path(tells_a_space);
    const auto found = files.find(id);
    if (found == files.end()) throw InputError(none_named("feature space", id, feature_space_ids()));
    return found->second;
  });
}

FeatureSpace load_feature_space(const std::string& id) {
  static MadeOnce<FeatureSpace> all;
  const fs::path file = feature_space_file(id);
  return all.of(file.string(), [&] {
    const Json document = read_json(file);
    const JsonReader reader(document, file.string());
    return FeatureSpace{id, read_all_names(reader.at("object_types")), read_all_names(reader.at("textures"))};
  });
}

FeatureSpace read_space(const JsonReader& name) {
  try {
    return load_feature_space(name.string());
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}: {}", name.file(), name.place(), e.what()));
  }
}

bool FeatureSet::contains(const std::string& object_type, const std::string& texture) const {
  return lgabench::contains(object_types, object_type) && lgabench::contains(textures, texture);
}

bool any_contains(const std::vector<FeatureSet>& sets, const std::string& object_type, const std::string& texture) {
  return std::any_of(sets.begin(), sets.end(),
                     [&](const FeatureSet& set) { return set.contains(object_type, texture); });
}

bool operator==(const FeatureSet& a, const FeatureSet& b) {
  return a.object_types == b.object_types && a.textures == b.textures;
}

Json to_json(const FeatureSet& set) { return {{"object_types", set.object_types}, {"textures", set.textures}}; }

FeatureSet read_feature_set(const JsonReader& reader, const FeatureSpace& space) {
  reader.only({"object_types", "textures"});
  return {read_names(reader.at("object_types"), space.object_types), read_names(reader.at("textures"), space.textures)};
}

}  // namespace lgabench
