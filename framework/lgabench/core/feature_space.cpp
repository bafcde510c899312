#include <lgabench/core/feature_space.hpp>

#include <fmt/format.h>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/read_space.hpp>
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

}  // namespace

FeatureSpace load_feature_space(const std::string& id) {
  static MadeOnce<FeatureSpace> all;
  const fs::path file = data_directory() / "spaces" / (id + ".json");
  return all.of(file.string(), [&] {
    if (const auto& known = shipped_names("spaces"); !contains(known, id))
      throw InputError(none_named("feature space", id, known));
    const Json document = read_json(file);
    const JsonReader reader(document, file.string());
    return FeatureSpace{id, reader.at("object_types").strings(), reader.at("textures").strings()};
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

bool operator==(const FeatureSet& a, const FeatureSet& b) {
  return a.object_types == b.object_types && a.textures == b.textures;
}

Json to_json(const FeatureSet& set) { return {{"object_types", set.object_types}, {"textures", set.textures}}; }

FeatureSet read_feature_set(const JsonReader& reader, const FeatureSpace& space) {
  reader.only({"object_types", "textures"});
  return {read_names(reader.at("object_types"), space.object_types), read_names(reader.at("textures"), space.textures)};
}

}  // namespace lgabench
