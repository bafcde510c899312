#include "hows.hpp"

#include <algorithm>
#include <map>
#include <string>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/turns.hpp>

#include "hows_json.hpp"

namespace lgabench {
namespace {

using Sets = std::vector<FeatureSet>;

// By the word that hows.json has for them.
std::map<std::string, Sets> sets_of(const Meaning& meaning) {
  std::vector<Sets> parts;
  for (const Turn& turn : meaning.turns)
    if (!contains(parts, turn.sets)) parts.push_back(turn.sets);
  std::map<std::string, Sets> sets{{"either", meaning.sets}};
  if (parts.size() == 2) sets.insert({{"first", parts[0]}, {"second", parts[1]}});
  return sets;
}

Json json_of(const Sets& sets) {
  Json json = Json::array();
  for (const FeatureSet& set : sets) json.push_back(to_json(set));
  return json;
}

}  // namespace

Hows::Hows(const Meaning& meaning) {
  const std::map<std::string, Sets> sets = sets_of(meaning);
  double sum = 0;
  for (Json how : hows_json()) {
    bool has_all = true;
    for (Json& turn : how["turns"]) {
      const auto found = sets.find(turn["of"]);
      if ((has_all = has_all && found != sets.end())) turn["sets"] = json_of(found->second);
      turn.erase("of");
    }
    if (!has_all) continue;
    const double weight = how["weight"];
    how.erase("weight");
    all_.push_back({read_unchecked_meaning(JsonReader(how, "hows.json")), weight});
    sum += weight;
  }
  for (How& how : all_) how.probability /= sum;
}

void Hows::saw(const Chosen& step) {
  std::vector<double> weights;
  double sum = 0;
  for (const auto& [meaning, probability] : all_) {
    double likelihood = is_done(meaning, step.on_table, step.brought);
    if (step.took) {
      const std::vector<Named> next = wanted(meaning, step.on_table, step.brought);
      const auto count = std::count_if(step.on_table.begin(), step.on_table.end(),
                                       [&next](const Named& one) { return contains(next, one); });
      likelihood = likelihood == 0 && contains(next, *step.took) ? 1. / static_cast<double>(count) : 0;
    }
    weights.push_back(probability * likelihood);
    sum += weights.back();
  }
  if (sum == 0) return;
  for (std::size_t i = 0; i < all_.size(); ++i) all_[i].probability = weights[i] / sum;
}

const Meaning& Hows::likeliest() const {
  return std::max_element(all_.begin(), all_.end(),
                          [](const How& a, const How& b) { return a.probability < b.probability; })
      ->meaning;
}

Hows::Odds Hows::odds(const std::vector<Named>& on_table, const std::vector<Named>& brought) const {
  Odds odds;
  for (const Named& one : on_table)
    if (std::none_of(odds.wanted.begin(), odds.wanted.end(), [&one](const auto& other) { return other.first == one; }))
      odds.wanted.emplace_back(one, 0);
  for (const auto& [meaning, probability] : all_) {
    if (probability == 0) continue;
    if (is_done(meaning, on_table, brought)) odds.done += probability;
    const std::vector<Named> next = wanted(meaning, on_table, brought);
    for (auto& [name, of_it] : odds.wanted)
      if (contains(next, name)) of_it += probability;
  }
  return odds;
}

}  // namespace lgabench
