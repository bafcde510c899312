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

// None where the four rows are not paired: other scenarios, seeds, scenes or policies.
std::optional<StageOutcomes> outcomes_of(const RunResults& run, const Steps& steps) {
  std::vector<Policies> rows;
  for (const Stage& stage : stages) rows.push_back(policies_of(run, steps, stage.method));
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

double mean_rate(const StageOutcomes& outcomes, std::size_t stage) {
  double sum = 0, weights = 0;
  for (std::size_t c = 0; c < outcomes.weights.size(); ++c) {
    double rates = 0;
    for (const std::vector<double>& policy : outcomes.rates[stage][c]) rates += mean(policy);
    sum += outcomes.weights[c] * rates / static_cast<double>(outcomes.rates[stage][c].size());
    weights += outcomes.weights[c];
  }
  return sum / weights;
}

std::array<Step, 3> steps_of(const StageOutcomes& outcomes, std::string_view name) {
  const SharedResamples scenes(outcomes.rates, outcomes.shared, name, outcomes.weights, SharedResamples::Draws::scenes),
      commands(outcomes.rates, outcomes.shared, name, outcomes.weights, SharedResamples::Draws::scenarios_too);
  std::array<Step, 3> steps;
  for (std::size_t i = 0; i < steps.size(); ++i)
    steps[i] = {mean_rate(outcomes, i + 1) - mean_rate(outcomes, i), scenes.difference(i, i + 1),
                commands.difference(i, i + 1)};
  return steps;
}

std::vector<Steps> all_steps(const RunResults& run, const std::vector<Table>& tables, const AboutSuite& about) {
  std::vector<Steps> all;
  for (const Table& table : tables) {
    const std::optional<Column> main = main_column(table, about);
    for (const int n : table.demonstrations()) {
      Steps steps{table.layout, table.engine, main->arm, n, 0, {}, {}, {}};
      bool whole = true;
      for (std::size_t i = 0; i < stages.size(); ++i) {
        const Row* row = table.find(main->arm, mean_scenario, stages[i].method, n);
        whole = whole && row && row->success;
        if (!whole) break;
        steps.success[i] = *row->success;
        steps.rows[i] = row->index;
      }
      if (whole) all.push_back(steps);
    }
  }
  std::vector<std::optional<StageOutcomes>> outcomes(all.size());
  in_parallel(all.size(), [&](std::size_t i) {
    Steps& steps = all[i];
    outcomes[i] = outcomes_of(run, steps);
    if (!outcomes[i]) return;
    steps.commands = static_cast<int>(outcomes[i]->weights.size());
    steps.steps = steps_of(*outcomes[i], fmt::format("report/steps/{}/{}/{}/{}", steps.layout, steps.engine, steps.arm,
                                                     steps.demonstrations));
  });
  all.erase(std::remove_if(all.begin(), all.end(), [](const Steps& steps) { return steps.commands == 0; }), all.end());
  return all;
}

std::string signed_interval(const Interval& interval) {
  return fmt::format("[{}, {}]", signed_text(interval.low), signed_text(interval.high));
}

Json to_json(const Steps& steps) {
  Json stages_json = Json::array(), steps_json = Json::array();
  for (std::size_t i = 0; i < stages.size(); ++i)
    stages_json.push_back({{"what", stages[i].what},
                           {"method", stages[i].method},
                           {"success", steps.success[i]},
                           {"row", steps.rows[i]}});
  for (const Step& step : steps.steps)
    steps_json.push_back({{"difference", step.difference},
                          {"low", step.interval.low},
                          {"high", step.interval.high},
                          {"over_commands", {{"low", step.over_commands.low}, {"high", step.over_commands.high}}}});
  return {{"layout", steps.layout},     {"engine", steps.engine},
          {"arm", steps.arm},           {"demonstrations", steps.demonstrations},
          {"commands", steps.commands}, {"stages", stages_json},
          {"steps", steps_json}};
}

}  // namespace lgabench::statistics
