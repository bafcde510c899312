#include <lgabench/report/pairs.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/rounding.hpp>

namespace lgabench::report {

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
  const std::vector<Episode>&a = first.episodes.at(arm), &b = second.episodes.at(arm);
  if (const std::string why = why_unpaired(first, second, arm); !why.empty())
    throw InputError(
        fmt::format("{} and {} cannot be paired: {}, arm {}: {}", first.key, second.key, first.scenario, arm, why));
  PolicyPair pair;
  pair.episodes = static_cast<int>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    pair.won_first += a[i].success() ? 1 : 0;
    pair.won_second += b[i].success() ? 1 : 0;
    pair.only_first += a[i].success() && !b[i].success() ? 1 : 0;
    pair.only_second += b[i].success() && !a[i].success() ? 1 : 0;
    pair.same_actions = pair.same_actions && a[i].action == b[i].action;
    pair.scenes.push_back(a[i].scene);
    pair.first.push_back(a[i].success() ? 1 : 0);
    pair.second.push_back(b[i].success() ? 1 : 0);
  }
  return pair;
}

void PairedRow::add(const std::string& scenario, const PolicyPair& pair, const std::string& participant) {
  auto row = std::find_if(rows_.begin(), rows_.end(), [&scenario](const Scenario& r) { return r.name == scenario; });
  if (row == rows_.end()) row = rows_.insert(rows_.end(), Scenario{scenario, {}, {}, {}});
  row->first.add(participant, pair.scenes, pair.first);
  row->second.add(participant, pair.scenes, pair.second);
  std::vector<double> differences = pair.second;
  for (std::size_t i = 0; i < differences.size(); ++i) differences[i] -= pair.first[i];
  row->differences.add(participant, pair.scenes, std::move(differences));
  if (!participant.empty()) participants_.insert(participant);
  ++policies_;
  total_.episodes += pair.episodes;
  total_.won_first += pair.won_first;
  total_.won_second += pair.won_second;
  total_.only_first += pair.only_first;
  total_.only_second += pair.only_second;
  total_.same_actions = total_.same_actions && pair.same_actions;
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

}  // namespace lgabench::report
