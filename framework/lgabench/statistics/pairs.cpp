#include <lgabench/statistics/pairs.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/rounding.hpp>

namespace lgabench::statistics {

bool same_action(const Episode& first, const Episode& second) {
  return (!first.action.empty() || first.done) && first.action == second.action && first.then == second.then &&
         first.done == second.done;
}

void EpisodePairs::count(bool first_won, bool second_won) {
  ++episodes;
  won_first += first_won;
  won_second += second_won;
  only_first += first_won && !second_won;
  only_second += second_won && !first_won;
}

void EpisodePairs::add(const Episode& a, const Episode& b) {
  count(a.success(), b.success());
  same_actions = same_actions && same_action(a, b);
}

void EpisodePairs::add(const EpisodePairs& others) {
  episodes += others.episodes;
  won_first += others.won_first;
  won_second += others.won_second;
  only_first += others.only_first;
  only_second += others.only_second;
  same_actions = same_actions && others.same_actions;
}

std::vector<double> PolicyPair::differences() const {
  std::vector<double> all = second;
  for (std::size_t i = 0; i < all.size(); ++i) all[i] -= first[i];
  return all;
}

std::optional<PolicyPair> pair_episodes(const std::vector<Episode>& first, const std::vector<Episode>& second,
                                        const std::vector<CommandResult>& commands) {
  const auto means_the_same = [&commands](const Episode& a, const Episode& b) {
    const Json &one = commands.at(a.command).truth, &other = commands.at(b.command).truth;
    return a.command == b.command || (!one.empty() && one == other);
  };
  if (!std::equal(first.begin(), first.end(), second.begin(), second.end(), means_the_same)) return {};
  PolicyPair pair;
  for (std::size_t i = 0; i < first.size(); ++i) {
    pair.add(first[i], second[i]);
    pair.scenes.push_back(second[i].scene);
    pair.first.push_back(first[i].success() ? 1 : 0);
    pair.second.push_back(second[i].success() ? 1 : 0);
  }
  return pair;
}

std::string why_unpaired(const CellResult& first, const CellResult& second, const std::string& arm) {
  const std::vector<Episode>&a = first.episodes.at(arm), &b = second.episodes.at(arm);
  if (a.size() != b.size()) return fmt::format("{} and {} episodes", a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].scene != b[i].scene) return fmt::format("scenes {} and {} at index {}", a[i].scene, b[i].scene, i);
    if (a[i].command != b[i].command)
      return fmt::format("commands {} and {} at index {}", a[i].command, b[i].command, i);
  }
  return "";
}

PolicyPair pair_policies(const CellResult& first, const CellResult& second, const std::string& arm) {
  if (const std::string why = why_unpaired(first, second, arm); !why.empty())
    throw InputError(
        fmt::format("{} and {} cannot be paired: {}, arm {}: {}", first.key, second.key, first.scenario, arm, why));
  return pair_episodes(first.episodes.at(arm), second.episodes.at(arm), first.commands).value();
}

void PairedRow::add(const std::string& scenario, const PolicyPair& pair, const std::string& participant) {
  auto row = std::find_if(rows_.begin(), rows_.end(), [&scenario](const Scenario& r) { return r.name == scenario; });
  if (row == rows_.end()) row = rows_.insert(rows_.end(), Scenario{scenario, {}, {}, {}});
  row->first.add(participant, pair.scenes, pair.first);
  row->second.add(participant, pair.scenes, pair.second);
  row->differences.add(participant, pair.scenes, pair.differences());
  if (!participant.empty()) participants_.insert(participant);
  ++policies_;
  total_.add(pair);
}

Samples PairedRow::samples(Outcomes Scenario::*which) const {
  Samples all;
  for (const Scenario& row : rows_) all.push_back((row.*which).sample());
  return all;
}

std::vector<std::pair<std::string, double>> PairedRow::by_scenario() const {
  std::vector<std::pair<std::string, double>> all;
  for (const Scenario& row : rows_) all.emplace_back(row.name, row.differences.sample().mean());
  return all;
}

std::string change_text(const Change& change) {
  return fmt::format("{} [{}, {}]", signed_text(change.difference), signed_text(change.interval.low),
                     signed_text(change.interval.high));
}

std::string p_text(double p) { return p < 0.001 ? "p < 0.001" : "p = " + fixed(p, 3); }

}  // namespace lgabench::statistics
