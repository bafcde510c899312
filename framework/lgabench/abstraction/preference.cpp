#include <lgabench/abstraction/preference.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <lgabench/core/terminal.hpp>

namespace lgabench {
namespace {

constexpr double sure = .95;  // that a person does what they prefer

std::vector<bool> pairs_of(const Meaning& meaning, const FeatureSpace& space) {
  std::vector<bool> pairs;
  for (const std::string& type : space.object_types)
    for (const std::string& texture : space.textures)
      pairs.push_back(!is_place(type) && meaning.belongs(type, texture));
  return pairs;
}

bool can_be_taken(const Instance& instance) { return instance.pixels > 0 && !is_place(instance.object_type); }

const Instance* find(const Observation& seen, std::uint8_t id) {
  const auto found =
      std::find_if(seen.instances.begin(), seen.instances.end(), [id](const Instance& one) { return one.id == id; });
  return found == seen.instances.end() ? nullptr : &*found;
}

// The first visible object that one of the two holds and the other does not.
std::optional<Instance> telling_object(const Meaning& a, const Meaning& b,
                                       const std::vector<const Demonstration*>& shown) {
  for (const Demonstration* one : shown)
    for (const Instance& instance : one->steps.at(0).observation.instances)
      if (can_be_taken(instance) &&
          a.belongs(instance.object_type, instance.texture) != b.belongs(instance.object_type, instance.texture))
        return instance;
  return std::nullopt;
}

void log(const Command& command, const Preference& preference) {
  const std::vector<double> probabilities = preference.probabilities();
  to_stdout("\"{}\":\n", command.utterance);
  for (const std::size_t i : preference.ranked())
    to_stdout("  {:.3f} {}\n", probabilities[i], one_line(preference.candidates()[i].text));
}

}  // namespace

Preference::Preference(const Meaning& words, const std::vector<Hypothesis>& hypotheses, const FeatureSpace& space) {
  std::vector<Hypothesis> all{{"what the words say", words}};
  all.insert(all.end(), hypotheses.begin(), hypotheses.end());
  for (Hypothesis& one : all) {
    std::vector<bool> pairs = pairs_of(one.meaning, space);
    bool known = false;
    for (std::size_t i = 0; i < candidates_.size(); ++i)
      known = known || (pairs_[i] == pairs && candidates_[i].meaning.which == one.meaning.which);
    if (known) continue;
    candidates_.push_back(std::move(one));
    pairs_.push_back(std::move(pairs));
  }
  const double others = std::max<double>(1, static_cast<double>(candidates_.size()) - 1);
  logs_.assign(candidates_.size(), std::log(.5 / others));
  logs_.front() = std::log(.5);
}

void Preference::took(const Observation& seen, std::uint8_t instance) {
  const auto in_view = std::count_if(seen.instances.begin(), seen.instances.end(), can_be_taken);
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    std::vector<std::uint8_t> held = grounded(candidates_[i].meaning, seen);
    held.erase(std::remove_if(held.begin(), held.end(),
                              [&seen](std::uint8_t id) { return is_place(find(seen, id)->object_type); }),
               held.end());
    const bool holds = std::find(held.begin(), held.end(), instance) != held.end();
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
  const auto rank = [this](std::size_t i) {
    return std::pair(-std::round(logs_[i] * digits), -std::count(pairs_[i].begin(), pairs_[i].end(), true));
  };
  std::vector<std::size_t> order(candidates_.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&rank](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  return order;
}

Selection preferred(const Command& command, const Selection& selected, const FeatureSpace& space,
                    const std::vector<Demonstration>& demonstrations, Services& services, AskPerson ask) {
  std::vector<const Demonstration*> shown;
  for (const Demonstration& one : demonstrations)
    if (one.instruction.utterance == command.utterance) shown.push_back(&one);
  if (!services.shows_truth || shown.empty()) return selected;
  const std::vector<Hypothesis> hypotheses = services.lm.hypotheses(command, space);
  if (hypotheses.empty()) {
    to_stdout("\"{}\": no hypotheses are known, what the words say stays\n", command.utterance);
    return selected;
  }
  Preference preference(selected.target, hypotheses, space);
  for (const Demonstration* one : shown)
    if (const auto instance = taken(*one, services.actions)) preference.took(one->steps.at(0).observation, *instance);
  const auto likeliest = [&preference](std::size_t place) {
    return preference.candidates()[preference.ranked()[place]].meaning;
  };
  if (ask == AskPerson::yes && preference.candidates().size() > 1)
    if (const auto object = telling_object(likeliest(0), likeliest(1), shown)) {
      const bool accepts = services.human.accepts(command, object->object_type, object->texture);
      to_stdout("\"{}\": the person was shown {}, {}, and said {}\n", command.utterance, object->object_type,
                object->texture, accepts ? "yes" : "no");
      preference.said(object->object_type, object->texture, accepts);
    }
  log(command, preference);
  Selection revised = selected;
  revised.target = likeliest(0);
  return revised;
}

}  // namespace lgabench
