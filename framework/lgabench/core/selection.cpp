#include <lgabench/core/selection.hpp>

#include <array>
#include <utility>

namespace lgabench {
namespace {

constexpr std::array<std::pair<Provenance, const char*>, 8> words{{{Provenance::none, "none"},
                                                                   {Provenance::rule, "rule"},
                                                                   {Provenance::recorded, "recorded"},
                                                                   {Provenance::live, "live"},
                                                                   {Provenance::cassette, "cassette"},
                                                                   {Provenance::truth, "truth"},
                                                                   {Provenance::simulated_edit, "simulated_edit"},
                                                                   {Provenance::human, "human"}}};

}  // namespace

SelectionCost& operator+=(SelectionCost& cost, const SelectionCost& more) {
  cost.lm_queries += more.lm_queries;
  cost.lm_tokens += more.lm_tokens;
  cost.lm_seconds += more.lm_seconds;
  cost.human_seconds += more.human_seconds;
  return cost;
}

SelectionCost operator-(const SelectionCost& all, const SelectionCost& before) {
  return {all.lm_queries - before.lm_queries, all.lm_tokens - before.lm_tokens, all.lm_seconds - before.lm_seconds,
          all.human_seconds - before.human_seconds};
}

std::string to_string(Provenance provenance) {
  for (const auto& [value, word] : words)
    if (value == provenance) return word;
  throw Error("a Provenance outside its enumeration");
}

Provenance provenance_from(const std::string& word) {
  for (const auto& [value, text] : words)
    if (text == word) return value;
  throw InputError("expected a provenance, got \"" + word + "\"");
}

Json distribution_json(const Selection& selection) {
  Json json{{"target", to_json(selection.target)}};
  if (selection.avoid) json["avoid"] = to_json(*selection.avoid);
  return json;
}

Json to_json(const Selection& selection) {
  Json json = distribution_json(selection);
  json["provenance"] = to_string(selection.provenance);
  json["source"] = selection.source;
  json["asked_as"] = selection.asked_as;
  json["cost"] = {{"lm_queries", selection.cost.lm_queries},
                  {"lm_tokens", selection.cost.lm_tokens},
                  {"lm_seconds", selection.cost.lm_seconds},
                  {"human_seconds", selection.cost.human_seconds}};
  return json;
}

Selection read_distribution(const JsonReader& reader, const FeatureSpace& space) {
  reader.only({"target", "avoid"});
  Selection selection;
  selection.target = read_feature_set(reader.at("target"), space);
  if (reader.has("avoid")) selection.avoid = read_feature_set(reader.at("avoid"), space);
  return selection;
}

}  // namespace lgabench
