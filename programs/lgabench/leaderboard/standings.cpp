#include <lgabench/leaderboard/standings.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

#include <lgabench/abstraction/quality.hpp>
#include <lgabench/leaderboard/areas.hpp>
#include <lgabench/leaderboard/units.hpp>
#include <lgabench/record/reference_rows.hpp>
#include <lgabench/statistics/bootstrap.hpp>
#include <lgabench/statistics/names.hpp>

namespace lgabench::leaderboard {
namespace {

using statistics::mean;

using WeightsOfScenarios = std::map<std::string, ArmWeights>;

WeightsOfScenarios weights_in(const Setting& setting) {
  WeightsOfScenarios all;
  for (const Setting::Scenario& scenario : setting.scenarios) all[scenario.id] = weights_of(scenario);
  return all;
}

}  // namespace

Rates rates_of(const Entry& entry, const std::string& only_arm, int only_demonstrations) {
  const Setting& setting = entry.setting;
  const WeightsOfScenarios by_scenario = weights_in(setting);
  std::map<std::pair<std::string, std::string>, std::map<std::uint64_t, std::vector<std::vector<double>>>> by_unit;
  for (const PlayedCell& cell : Units(entry)) {
    const int n = cell.place.demonstrations;
    if (!only_arm.empty() && ((n != 0 && n != only_demonstrations) || cell.outcomes.count(only_arm) == 0)) continue;
    std::vector<double> scenes(cell.outcomes.begin()->second.size());
    const ArmWeights& weights = by_scenario.at(cell.place.scenario);
    for (const auto& [arm, letters] : cell.outcomes) {
      const auto found = weights.find(arm);
      const double weight = !only_arm.empty()        ? arm == only_arm
                            : found != weights.end() ? found->second
                            : weights.empty()        ? 1 / static_cast<double>(cell.outcomes.size())
                                                     : 0;
      for (std::size_t i = 0; i < scenes.size(); ++i) scenes[i] += weight * is_success(letters[i]);
    }
    by_unit[{cell.place.scenario, cell.place.layout}][cell.place.seed].push_back(std::move(scenes));
  }
  Rates rates;
  for (const Setting::Scenario& scenario : setting.scenarios)
    for (const std::string& layout : setting.layouts) {
      const auto played = by_unit.find({scenario.id, layout});
      if (played == by_unit.end()) continue;  // a scenario without the arm, or the second of a pair
      const auto& by_seed = played->second;
      auto& unit = rates.emplace_back();
      for (const std::uint64_t seed : setting.seeds) {
        const auto found = by_seed.find(seed);  // one that learns nothing plays shared scenes once, for all seeds
        const auto& cells = found == by_seed.end() ? by_seed.begin()->second : found->second;
        std::vector<double>& scenes = unit.emplace_back(cells.front().size());
        for (const std::vector<double>& cell : cells)
          for (std::size_t i = 0; i < scenes.size(); ++i) scenes[i] += cell[i] / static_cast<double>(cells.size());
      }
    }
  return rates;
}

namespace {

Means means_of(const Setting& setting, const std::vector<PlayedCell>& cells) {
  const WeightsOfScenarios weights = weights_in(setting);
  Means means;
  std::map<std::string, std::vector<double>> by_scenario;
  std::map<int, std::map<std::string, std::vector<double>>> at;
  std::map<std::string, std::map<std::string, std::vector<double>>> in_arm;
  for (const PlayedCell& cell : cells) {
    double rate = static_cast<double>(cell.successes()) / cell.episodes();
    if (const ArmWeights& arm_weights = weights.at(cell.place.scenario); !arm_weights.empty()) {
      rate = 0;
      for (const auto& [arm, weight] : arm_weights)
        rate += weight * successes(cell.outcomes.at(arm)) / static_cast<double>(cell.outcomes.at(arm).size());
    }
    by_scenario[cell.place.scenario].push_back(rate);
    at[cell.place.demonstrations][cell.place.scenario].push_back(rate);
    for (const auto& [arm, letters] : cell.outcomes)
      in_arm[arm][cell.place.scenario].push_back(successes(letters) / static_cast<double>(letters.size()));
  }
  const auto over_scenarios = [](const std::map<std::string, std::vector<double>>& scenarios) {
    std::vector<double> each;
    for (const auto& scenario : scenarios) each.push_back(mean(scenario.second));
    return mean(each);
  };
  for (const auto& [scenario, rates] : by_scenario) means.in_scenario[scenario] = mean(rates);
  for (const auto& [n, scenarios] : at) means.at[n] = over_scenarios(scenarios);
  for (const auto& [arm, scenarios] : in_arm) means.in_arm[arm] = over_scenarios(scenarios);
  means.score = over_scenarios(by_scenario);
  return means;
}

void add_rates(Standing& standing) {
  const Entry& entry = *standing.entry;
  static_cast<Means&>(standing) = means_of(entry.setting, Units(entry).cells());
  if (entry.setting.paired()) standing.each = means_of(entry.setting, entry.cells);
  for (const PlayedCell& cell : entry.cells) {
    standing.episodes += cell.episodes();
    standing.failed_cells += !cell.failed.empty();
  }
  for (const std::string& axis : axes_of(entry.setting)) standing.areas[axis] = relative_area(entry, axis);
}

// The mean of a share over the cells' Selections: each command, each set and each kind of feature counts alike.
std::optional<double> mean_share(const Entry& entry, std::optional<double> NameQuality::*share) {
  std::vector<double> all;
  for (const PlayedCell& cell : entry.cells) {
    const auto lists = entry.phi.find(cell.place.scenario);
    if (lists == entry.phi.end() || !cell.failed.empty()) continue;
    for (const Json& command : lists->at(cell.phi))
      for (const auto& set : read_quality(JsonReader(command.at("quality"), "quality")))
        for (const NameQuality& names : {set.second.object_types, set.second.textures})
          if (const std::optional<double> value = names.*share) all.push_back(*value);
  }
  return all.empty() ? std::nullopt : std::optional(mean(all));
}

// Whether nobody was asked the questions that the cell counts.
bool not_asked(const Entry& entry, const PlayedCell& cell) {
  const auto lists = entry.phi.find(cell.place.scenario);
  if (lists == entry.phi.end() || cell.lm_queries == 0) return false;
  const Json& commands = lists->at(cell.phi);
  return std::any_of(commands.begin(), commands.end(), [](const Json& command) {
    const Json& selection = command.at("selection");
    return !statistics::was_asked(selection.value("provenance", ""), selection.value("source", ""));
  });
}

void add_costs(Standing& standing) {
  const Entry& entry = *standing.entry;
  const auto cells = static_cast<double>(entry.cells.size()) - standing.failed_cells;
  for (const PlayedCell& cell : entry.cells) {
    if (!cell.failed.empty()) continue;  // what it cost is not known
    standing.cells_not_asked += not_asked(entry, cell);
    standing.lm_queries += cell.lm_queries / cells;
    standing.lm_tokens += cell.lm_tokens / cells;
    standing.learn_s += cell.learn_s / cells;
  }
  standing.precision = mean_share(entry, &NameQuality::precision);
  standing.recall = mean_share(entry, &NameQuality::recall);
}

// Success over the arms of the abstraction track.
std::optional<double> in_track(const Standing& standing, const Track& track) {
  std::vector<double> rates;
  for (const std::string& arm : track.arms)
    if (const auto found = standing.in_arm.find(arm); found != standing.in_arm.end()) rates.push_back(found->second);
  return rates.empty() ? std::nullopt : std::optional(mean(rates));
}

// What the abstraction track says beside success over all arms.
void add_gaps(std::vector<Standing>& all, const Track& track) {
  std::optional<double> any, truth;
  for (Standing& standing : all) {
    standing.in_track = in_track(standing, track);
    const Competitor& row = standing.entry->identity.row;
    if (row.acts || policy_of(*standing.entry) != "heat_map" || !standing.entry->identity.conditions.none()) continue;
    if (row.id == "factorial" && row.options.value("input", Json()) == "object_mask") any = standing.in_track;
    if (row.id == "human") truth = standing.in_track;
  }
  if (!any || !truth || *truth <= *any) return;
  for (Standing& standing : all)
    if (standing.in_track) standing.gap_closed = (*standing.in_track - *any) / (*truth - *any);
}

// Each entry's rank among those that are ranked, given all entries' shared resamples.
void add_ranks(std::vector<Standing>& all, const statistics::SharedResamples& resamples) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].not_ranked.empty()) continue;
    std::vector<double> p;
    std::vector<bool> better;
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (j == i || !all[j].not_ranked.empty()) continue;
      p.push_back(resamples.p(i, j));
      better.push_back(all[j].score > all[i].score);
    }
    const std::vector<double> adjusted = statistics::holm(p);
    int rank = 1;
    for (std::size_t k = 0; k < adjusted.size(); ++k) rank += better[k] && adjusted[k] <= statistics::alpha;
    all[i].rank = rank;
  }
}

}  // namespace

std::vector<Standing> standings(const std::vector<const Entry*>& table, const Track& track, Ranking ranking) {
  std::vector<Standing> all;
  std::vector<Rates> rates;
  for (const Entry* entry : table) {
    if (entry->is_withdrawn() || !entry->was_replayed() || !is_in(*entry, ranking)) continue;
    Standing& standing = all.emplace_back();
    standing.entry = entry;
    standing.not_ranked = why_not_ranked(*entry, track);
    add_rates(standing);
    add_costs(standing);
    rates.push_back(rates_of(*entry));
  }
  if (all.empty()) return all;
  const Setting& setting = all.front().entry->setting;
  const statistics::SharedResamples resamples(rates, setting.shared_scenes(),
                                              fmt::format("leaderboard/{}/{}", hash(setting), setting.scene_seed));
  for (std::size_t i = 0; i < all.size(); ++i) all[i].interval = resamples.interval(i);
  add_ranks(all, resamples);
  if (track.kind == Track::abstraction) add_gaps(all, track);
  const auto is_reference = [](const Standing& s) { return s.entry->identity.row.is_reference(); };
  const auto order = [&](const Standing& s) { return std::tuple(-s.score, is_reference(s), s.entry->id()); };
  std::sort(all.begin(), all.end(), [&](const Standing& a, const Standing& b) { return order(a) < order(b); });
  int before = 1;
  for (Standing& standing : all)
    if (standing.rank) before = *standing.rank = std::max(*standing.rank, before);
  const auto random =
      std::find_if(all.begin(), all.end(), [](const Standing& s) { return s.entry->identity.row.id == random_object; });
  if (random != all.end())
    for (Standing& standing : all) standing.below_random = !is_reference(standing) && standing.score < random->score;
  return all;
}

std::vector<Standing> not_yet_replayed(const std::vector<const Entry*>& table) {
  std::vector<Standing> all;
  for (const Entry* entry : table) {
    if (entry->is_withdrawn() || entry->was_replayed()) continue;
    Standing& standing = all.emplace_back();
    standing.entry = entry;
    standing.not_ranked = why_not_ranked(*entry);
    add_rates(standing);
  }
  return all;
}

std::vector<std::vector<const Entry*>> tables(const std::vector<Entry>& entries) {
  std::map<std::tuple<std::string, std::string, std::string, std::uint64_t>, std::vector<const Entry*>> all;
  for (const Entry& entry : entries)
    all[{entry.setting.suite, entry.setting.preset, entry.identity.preset_sha256, entry.setting.scene_seed}].push_back(
        &entry);
  std::vector<std::vector<const Entry*>> list;
  for (auto& item : all) list.push_back(std::move(item.second));
  return list;
}

}  // namespace lgabench::leaderboard
