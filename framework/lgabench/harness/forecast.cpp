#include <lgabench/harness/forecast.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include <lgabench/core/resources.hpp>

namespace lgabench {
namespace {

// Bytes on the disk, as found in runs of 0.2.0.
constexpr double cell_bytes = 28e3, episode_bytes = 400, demonstration_bytes = 21e3;

double number(const Json& scenario, const char* list) {
  const auto all = scenario.find(list);
  return all == scenario.end() ? 0 : static_cast<double>(all->size());
}

}  // namespace

std::string duration_text(double seconds) {
  const auto minutes = static_cast<long long>(seconds / 60 + .5);
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  return minutes < 60 ? fmt::format("{} min", minutes) : fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

std::string size_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} KB", bytes / 1e3);
  return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.1f} GB", bytes / 1e9);
}

std::string Forecast::text(int jobs, const std::string& purpose) const {
  const std::string count = fmt::format("{} cell{}", cells - there, cells - there == 1 ? "" : "s");
  const std::string what = purpose.empty() ? fmt::format("{} to compute, {} already computed:", count, there)
                                           : fmt::format("{}: {},", purpose, count);
  return fmt::format("{} {} with {} worker{}", what, duration(), jobs, jobs == 1 ? "" : "s");
}

std::string Forecast::duration() const {
  constexpr double shown_s = .5;
  if (unknown && wall_s < shown_s) return "an unknown time";
  return (unknown ? "unknown, at least " : "about ") + duration_text(wall_s);
}

Forecast forecast(const std::vector<const Cell*>& complete, const std::vector<const Cell*>& missing, const Costs& costs,
                  int jobs, const std::function<bool(const Cell&)>& is_unknown) {
  Forecast all;
  const auto row_of = [&all](const Cell& cell) -> Forecast::Row& {
    for (Forecast::Row& row : all.rows)
      if (row.name == cell.method.name) return row;
    all.rows.push_back({cell.method.name, 0, 0, 0, ""});
    return all.rows.back();
  };
  // A cell of fewer demonstrations takes the first of those that one of more takes.
  std::map<std::tuple<std::string, std::string, std::string, std::string, std::uint64_t>, double> demonstrations;
  std::map<std::string, bool> unknown_rows;  // by name
  const auto add = [&](const Cell& cell, bool there) {
    Forecast::Row& row = row_of(cell);
    ++row.cells;
    ++all.cells;
    row.there += there;
    all.there += there;
    if (there) return;
    const std::string other = measured_on(cell);
    auto known_row = unknown_rows.find(row.name);
    if (known_row == unknown_rows.end())
      known_row = unknown_rows.emplace(row.name, !costs.knows(row.name) && is_unknown(cell)).first;
    const bool unknown = known_row->second;
    const double seconds =
        unknown ? costs.expected_seconds(row.name, least_seconds(cell)) : costs.expected_seconds(cell);
    row.unknown = row.unknown || unknown;
    all.unknown = all.unknown || unknown;
    row.based_on = unknown                 ? "nobody: what its own plugin takes is unknown"
                   : costs.knows(row.name) ? "this run's cells"
                   : other.empty()         ? "cells measured elsewhere"
                                           : other + "'s cells";
    row.seconds += seconds;
    all.work_s += seconds;
    all.longest_s = std::max(all.longest_s, seconds);
    all.run_bytes += cell_bytes + episode_bytes * cell.episodes *
                                      number(*cell.scenario, cell.scenario->contains("played") ? "played" : "tests");
    double& most = demonstrations[{cell.scenario_id(), cell.layout, cell.engine, row.name, cell.training_seed}];
    most = std::max(most, cell.demonstrations * number(*cell.scenario, "commands"));
  };
  for (const Cell* cell : missing) add(*cell, false);
  for (const Cell* cell : complete) add(*cell, true);
  for (const auto& each : demonstrations) all.cache_bytes += demonstration_bytes * each.second;
  const double cores = std::min(jobs, usable_cores());
  all.wall_s = std::max(all.work_s / cores, all.longest_s);
  return all;
}

}  // namespace lgabench
