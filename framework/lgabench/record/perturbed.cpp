#include <lgabench/record/perturbed.hpp>

#include <limits>

namespace lgabench {
namespace {

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

std::string text_at(const JsonReader& reader) { return reader.json().is_null() ? "" : reader.string(); }

}  // namespace

Json to_json(const PerturbedEpisode& e) {
  Json json{{"arm", e.arm}, {"index", e.index}, {"axis", text_or_null(e.axis)}, {"level", e.level}};
  for (std::size_t part = 0; part < parts; ++part) json[part_names[part]] = text_or_null(e.hashes[part]);
  json["read"] = text_or_null(e.read);
  if (!e.names.empty()) json["names"] = e.names;
  json["target_scale"] = e.target_scale;
  return json;
}

PerturbedEpisode read_perturbed_episode(const JsonReader& reader) {
  constexpr long long most = std::numeric_limits<int>::max();
  PerturbedEpisode e;
  e.arm = reader.at("arm").string();
  e.index = static_cast<int>(reader.at("index").integer(0, most));
  e.axis = text_at(reader.at("axis"));
  e.level = static_cast<int>(reader.at("level").integer(e.axis.empty() ? 0 : 1, e.axis.empty() ? 0 : most));
  for (std::size_t part = 0; part < parts; ++part) e.hashes[part] = text_at(reader.at(part_names[part]));
  e.read = text_at(reader.at("read"));
  if (reader.has("names")) e.names = text_at(reader.at("names"));
  if (reader.has("target_scale")) e.target_scale = reader.at("target_scale").number();
  return e;
}

}  // namespace lgabench
