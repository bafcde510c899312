#include <lgabench/abstraction/preference.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench {
namespace {

constexpr double sure = .95;  // that a person does what they prefer

// By types and textures of each set: a name is looked up once.
std::vector<bool> pairs_of(const Meaning& meaning, const FeatureSpace& space) {
  const auto held = [](const std::vector<std::string>& names, const std::vector<std::string>& of_space) {
    std::vector<bool> all;
    for (const std::string& name : of_space) all.push_back(!is_place(name) && contains(names, name));
    return all;
  };
  std::vector<bool> pairs(space.object_types.size() * space.textures.size(), false);
  for (const FeatureSet& set : meaning.sets) {
    const std::vector<bool> types = held(set.object_types, space.object_types),
                            textures = held(set.textures, space.textures);
    for (std::size_t i = 0; i < types.size(); ++i)
      for (std::size_t j = 0; types[i] && j < textures.size(); ++j)
        if (textures[j]) pairs[i * textures.size() + j] = true;
  }
  return pairs;
}

bool can_be_taken(const Instance& instance) { return instance.pixels > 0 && !is_place(instance.object_type); }

using Pairs = std::set<std::pair<std::string, std::string>>;  // of types and textures

// The visible object, beside those, of which it is least certain whether the person takes it; the first of equals.
std::optional<Instance> uncertain_object(const Preference& preference, const Pairs& but,
                                         const std::vector<const Demonstration*>& shown) {
  constexpr double least = .01;  // what is known needs no question
  const std::vector<double> probabilities = preference.probabilities();
  std::optional<Instance> best;
  double most = least;
  for (const Demonstration* one : shown)
    for (const Instance& instance : one->steps.at(0).observation.instances) {
      if (!can_be_taken(instance) || but.count({instance.object_type, instance.texture}) > 0) continue;
      double yes = 0;
      for (std::size_t i = 0; i < probabilities.size(); ++i)
        if (preference.candidates()[i].meaning.belongs(instance.object_type, instance.texture)) yes += probabilities[i];
      constexpr double alike = 1e-9;
      if (const double either = std::min(yes, 1 - yes); either > most + alike) {
        most = either;
        best = instance;
      }
    }
  return best;
}

void log(const Command& command, const Preference& preference) {
  const std::vector<double> probabilities = preference.probabilities();
  to_stdout("\"{}\":\n", command.utterance);
  constexpr std::size_t most = 50;
  const std::vector<std::size_t> ranked = preference.ranked();
  for (std::size_t i = 0; i < std::min(most, ranked.size()); ++i)
    to_stdout("  {:.3f} {}\n", probabilities[ranked[i]], one_line(preference.candidates()[ranked[i]].text));
}

}  // namespace

Preference::Preference(const Meaning& words, const std::vector<Hypothesis>& hypotheses, const FeatureSpace& space,
                       const std::vector<Hypothesis>& unlisted, double share) {
  const auto sum_of = [](const std::vector<Hypothesis>& some) {
    return std::accumulate(some.begin(), some.end(), 0.0,
                           [](double sum, const Hypothesis& one) { return sum + one.weight; });
  };
  const double listed = sum_of(hypotheses), rest = sum_of(unlisted);
  const double of_words = hypotheses.empty() ? 1 : listed / static_cast<double>(hypotheses.size());
  std::map<std::pair<std::vector<bool>, std::string>, std::size_t> known;
  const auto add = [&](const Hypothesis& one, double prior) {
    std::vector<bool> pairs = pairs_of(one.meaning, space);
    Meaning rule;
    rule.which = one.meaning.which;
    rule.turns = one.meaning.turns;
    const auto [at, is_new] =
        known.try_emplace({pairs, rule.is_product() ? "" : canonical(to_json(rule))}, candidates_.size());
    if (!is_new) {
      logs_[at->second] = std::log(std::exp(logs_[at->second]) + prior);
      return;
    }
    candidates_.push_back(one);
    pairs_.push_back(std::count(pairs.begin(), pairs.end(), true));
    logs_.push_back(std::log(prior));
  };
  if (unlisted.empty()) share = 0;
  add({"what the words say", words, of_words}, (1 - share) * of_words / (listed + of_words));
  for (const Hypothesis& one : hypotheses) add(one, (1 - share) * one.weight / (listed + of_words));
  for (const Hypothesis& one : unlisted) add(one, share * one.weight / rest);
}

void Preference::took(const Observation& seen, std::uint8_t instance) {
  const std::vector<Placed> visible = placed(seen);
  const auto in_view = std::count_if(seen.instances.begin(), seen.instances.end(), can_be_taken);
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    std::vector<std::uint8_t> held = grounded(candidates_[i].meaning, visible, seen.brought);
    for (const Placed& one : visible)
      if (is_place(one.instance.object_type))
        held.erase(std::remove(held.begin(), held.end(), one.instance.id), held.end());
    const bool holds = contains(held, instance);
    logs_[i] +=
        holds ? std::log(sure / static_cast<double>(held.size())) : std::log((1 - sure) / static_cast<double>(in_view));
  }
}

void Preference::said(const std::string& object_type, const std::string& texture, bool accepts) {
  for (std::size_t i = 0; i < candidates_.size(); ++i)
    logs_[i] += std::log(candidates_[i].meaning.belongs(object_type, texture) == accepts ? sure : 1 - sure);
}

std::vector<double> Preference::probabilities() const {
  const double most = *std::max_element(logs_.begin(), logs_.end());
  std::vector<double> all;
  for (const double one : logs_) all.push_back(std::exp(one - most));
  const double sum = std::accumulate(all.begin(), all.end(), 0.0);
  for (double& one : all) one /= sum;
  return all;
}

std::vector<std::size_t> Preference::ranked() const {
  constexpr double digits = 1e9;  // what differs by less is equal
  const auto rank = [this](std::size_t i) { return std::pair(-std::round(logs_[i] * digits), pairs_[i]); };
  std::vector<std::size_t> order(candidates_.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&rank](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  return order;
}

Selection preferred(const Command& command, const Selection& selected, const FeatureSpace& space,
                    const std::vector<Demonstration>& demonstrations, Services& services, const Asking& asking) {
  std::vector<const Demonstration*> shown;
  for (const Demonstration& one : demonstrations)
    if (one.instruction.utterance == command.utterance) shown.push_back(&one);
  if (!services.shows_truth || shown.empty()) return selected;
  const bool asks_model = asking.share < 1 || asking.unlisted.empty();
  const std::vector<Hypothesis> hypotheses =
      asks_model ? services.lm.hypotheses(command, space) : std::vector<Hypothesis>();
  if (asks_model && hypotheses.empty()) {
    to_stdout("\"{}\": no hypotheses are known; the Selection stays as the words say\n", command.utterance);
    return selected;
  }
  Preference preference(selected.target, hypotheses, space, asking.unlisted, asking.share);
  for (const Demonstration* one : shown)
    for (const Step& step : one->steps)
      if (const auto instance = taken(step, services.actions)) preference.took(step.observation, *instance);
  Pairs asked;
  for (int i = 0; i < asking.questions; ++i) {
    const auto object = uncertain_object(preference, asked, shown);
    if (!object) break;
    asked.emplace(object->object_type, object->texture);
    const bool accepts = services.human.accepts(command, object->object_type, object->texture);
    to_stdout("\"{}\": the person was shown {}, {}, and said {}\n", command.utterance, object->object_type,
              object->texture, accepts ? "yes" : "no");
    preference.said(object->object_type, object->texture, accepts);
  }
  log(command, preference);
  Selection revised = selected;
  revised.target = preference.candidates()[preference.ranked().front()].meaning;
  return revised;
}

}  // namespace lgabench
