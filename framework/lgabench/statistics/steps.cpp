#include <lgabench/statistics/steps.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include <lgabench/core/parallel.hpp>
#include <lgabench/core/rounding.hpp>
#include <lgabench/statistics/bootstrap.hpp>
#include <lgabench/statistics/claims_field.hpp>
#include <lgabench/statistics/pairs.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::statistics {
namespace {

using Policies = std::map<std::pair<std::string, long long>, const CellResult*>;  // by scenario and training seed

// A stage's finished cells; empty where one failed, erred on purpose, or has answers of people.
Policies policies_of(const RunResults& run, const Steps& steps, const char* method) {
  Policies all;
  for (const CellResult& cell : run.cells) {
    if (cell.method != method || cell.layout != steps.layout || cell.engine != steps.engine ||
        cell.demonstrations != steps.demonstrations || !has_arm(cell, steps.arm) || cell.ambiguous.count(steps.arm) > 0)
      continue;
    if (cell.failed || !cell.participant.empty()) return {};
    all[{cell.scenario, cell.training_seed}] = &cell;
  }
  return all;
}

// The success of one cell, by command.
std::map<std::size_t, std::vector<double>> by_command(const CellResult& cell, const std::string& arm) {
  std::map<std::size_t, std::vector<double>> all;
  for (const Episode& episode : cell.episodes.at(arm)) all[episode.command].push_back(episode.success() ? 1 : 0);
  return all;
}

// None where the rows are not paired: other scenarios, seeds, scenes or policies.
std::optional<StageOutcomes> outcomes_of(const RunResults& run, const Steps& steps) {
  std::vector<Policies> rows;
  for (const Steps::Played& one : steps.played) rows.push_back(policies_of(run, steps, one.stage->method));
  std::map<std::pair<std::string, std::size_t>, std::size_t> commands;  // scenario and command -> its place
  std::map<std::string, const CellResult*> first;                       // of each scenario
  StageOutcomes outcomes{std::vector<std::vector<std::vector<std::vector<double>>>>(rows.size()), {}, true};
  for (const auto& [place, cell] : rows.front()) {
    const auto [one, is_first] = first.emplace(place.first, cell);
    outcomes.shared = outcomes.shared && why_unpaired(*one->second, *cell, steps.arm).empty();
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const auto same = rows[r].find(place);
      if (rows[r].size() != rows.front().size() || same == rows[r].end() ||
          !why_unpaired(*cell, *same->second, steps.arm).empty() ||
          same->second->options.value("policy", Json()) != cell->options.value("policy", Json()))
        return {};
      const double episodes = static_cast<double>(cell->episodes.at(steps.arm).size());
      for (auto& [command, rates] : by_command(*same->second, steps.arm)) {
        const auto [at, is_new] = commands.emplace(std::pair(place.first, command), commands.size());
        if (is_new) outcomes.weights.push_back(static_cast<double>(rates.size()) / episodes);
        outcomes.rates[r].resize(commands.size());
        outcomes.rates[r][at->second].push_back(std::move(rates));
      }
    }
  }
  for (const auto& command : outcomes.rates.front())  // each policy plays as many scenes of a command
    for (const auto& policy : command)
      if (policy.size() != command.front().size() || command.size() != outcomes.rates.front().front().size()) return {};
  return outcomes.weights.empty() ? std::nullopt : std::optional(std::move(outcomes));
}

}  // namespace

namespace {

double mean_rate_of(const StageOutcomes& outcomes, std::size_t stage, std::size_t command) {
  const auto& policies = outcomes.rates[stage][command];
  double rates = 0;
  for (const std::vector<double>& policy : policies) rates += mean(policy);
  return rates / static_cast<double>(policies.size());
}

}  // namespace

double mean_rate(const StageOutcomes& outcomes, std::size_t stage) {
  double sum = 0, weights = 0;
  for (std::size_t c = 0; c < outcomes.weights.size(); ++c) {
    sum += outcomes.weights[c] * mean_rate_of(outcomes, stage, c);
    weights += outcomes.weights[c];
  }
  return sum / weights;
}

std::vector<Step> steps_of(const StageOutcomes& outcomes, std::string_view name) {
  const SharedResamples scenes(outcomes.rates, outcomes.shared, name, outcomes.weights);
  std::vector<Step> steps;
  for (std::size_t i = 0; i + 1 < outcomes.rates.size(); ++i) {
    std::vector<double> by_command;
    for (std::size_t c = 0; c < outcomes.weights.size(); ++c)
      by_command.push_back(mean_rate_of(outcomes, i + 1, c) - mean_rate_of(outcomes, i, c));
    const Interval interval = scenes.difference(i, i + 1);
    steps.push_back({mean_rate(outcomes, i + 1) - mean_rate(outcomes, i), interval,
                     over_clusters(by_command, outcomes.weights, interval)});
  }
  return steps;
}

std::vector<Steps> all_steps(const RunResults& run, const std::vector<Table>& tables, const AboutSuite& about) {
  std::vector<Steps> all;
  for (const Table& table : tables) {
    const std::optional<Column> main = main_column(table, about);
    for (const int n : table.demonstrations()) {
      Steps steps{table.layout, table.engine, main->arm, n, 0, {}, {}};
      bool whole = true;
      for (const Stage& stage : stages) {
        const Row* row = table.find(main->arm, mean_scenario, stage.method, n);
        if (row && row->success)
          steps.played.push_back({&stage, *row->success, row->index});
        else
          whole = whole && !stage.needed;
      }
      if (whole) all.push_back(std::move(steps));
    }
  }
  in_parallel(all.size(), [&](std::size_t i) {
    Steps& steps = all[i];
    std::optional<StageOutcomes> outcomes = outcomes_of(run, steps);
    if (!outcomes) {  // of a row that is not needed
      steps.played.erase(std::remove_if(steps.played.begin(), steps.played.end(),
                                        [](const Steps::Played& one) { return !one.stage->needed; }),
                         steps.played.end());
      outcomes = outcomes_of(run, steps);
    }
    if (!outcomes) return;
    steps.commands = static_cast<int>(outcomes->weights.size());
    steps.steps = steps_of(*outcomes, fmt::format("report/steps/{}/{}/{}/{}", steps.layout, steps.engine, steps.arm,
                                                  steps.demonstrations));
  });
  all.erase(std::remove_if(all.begin(), all.end(), [](const Steps& steps) { return steps.commands == 0; }), all.end());
  return all;
}

std::string signed_interval(const std::optional<Interval>& interval) {
  if (!interval) return "undecided";
  return fmt::format("[{}, {}]", signed_text(interval->low), signed_text(interval->high));
}

Json to_json(const Steps& steps) {
  Json stages_json = Json::array(), steps_json = Json::array();
  for (const Steps::Played& one : steps.played)
    stages_json.push_back(
        {{"what", one.stage->what}, {"method", one.stage->method}, {"success", one.success}, {"row", one.row}});
  for (const Step& step : steps.steps) {
    steps_json.push_back({{"difference", step.difference}, {"low", step.interval.low}, {"high", step.interval.high}});
    if (step.over_commands)
      steps_json.back()["over_commands"] = {{"low", step.over_commands->low}, {"high", step.over_commands->high}};
  }
  return {{"layout", steps.layout},     {"engine", steps.engine},
          {"arm", steps.arm},           {"demonstrations", steps.demonstrations},
          {"commands", steps.commands}, {"stages", stages_json},
          {"steps", steps_json}};
}

}  // namespace lgabench::statistics
