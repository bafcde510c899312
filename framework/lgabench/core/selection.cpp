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
  cost.human_queries += more.human_queries;
  return cost;
}

SelectionCost operator-(const SelectionCost& all, const SelectionCost& before) {
  return {all.lm_queries - before.lm_queries, all.lm_tokens - before.lm_tokens, all.lm_seconds - before.lm_seconds,
          all.human_seconds - before.human_seconds, all.human_queries - before.human_queries};
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

bool operator==(const SecondSet& a, const SecondSet& b) {
  return a.role == b.role && static_cast<const FeatureSet&>(a) == static_cast<const FeatureSet&>(b);
}

Json distribution_json(const Selection& selection) {
  Json json{{"target", to_json(selection.target)}};
  if (selection.second) json[selection.second->role] = to_json(*selection.second);
  return json;
}

Json distribution_of(Json selection) {
  for (const char* told_beside : {"provenance", "source", "asked_as", "cost"}) selection.erase(told_beside);
  return selection;
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
  if (selection.cost.human_queries > 0) json["cost"]["human_queries"] = selection.cost.human_queries;
  return json;
}

Selection read_distribution(const JsonReader& reader, const FeatureSpace& space,
                            const std::optional<SecondRole>& second) {
  std::vector<std::string> members{"target"};
  if (second) members.push_back(second->id);
  reader.only(members);
  Selection selection;
  selection.target = read_meaning(reader.at("target"), space);
  if (second && reader.has(second->id))
    selection.second = SecondSet{read_feature_set(reader.at(second->id), space), second->id};
  return selection;
}

}  // namespace lgabench
