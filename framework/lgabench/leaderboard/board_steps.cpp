#include <lgabench/leaderboard/board_steps.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/rounding.hpp>
#include <lgabench/leaderboard/titles.hpp>
#include <lgabench/report/about_suite.hpp>
#include <lgabench/report/names.hpp>

namespace lgabench::leaderboard {
namespace {

using report::stages;

bool has_each_of(const Json& options, const Json& some) {
  return std::all_of(some.items().begin(), some.items().end(), [&](const auto& option) {
    return options.contains(option.key()) && options[option.key()] == option.value();
  });
}

// The row of each stage with the options of the truth's, which has all that the others have; nullptr where there is
// none.
std::array<const Entry*, stages.size()> rows_of(const std::vector<Standing>& table) {
  std::array<const Entry*, stages.size()> rows{};
  for (std::size_t i = stages.size(); i-- > 0;)
    for (const Standing& s : table) {
      const Competitor& row = s.entry->identity.row;
      if (row.id == stages[i].method && !row.is_reference() && (!row.acts || row.acts->id == "lga") &&
          policy_of(*s.entry) == "heat_map" && answers_file(s.entry->identity).empty() &&
          (!rows.back() || has_each_of(rows.back()->identity.row.options, row.options)))
        rows[i] = s.entry;
    }
  return rows;
}

}  // namespace

std::optional<BoardSteps> steps_of(const std::vector<Standing>& table) {
  const std::array<const Entry*, stages.size()> rows = rows_of(table);
  if (std::count(rows.begin(), rows.end(), nullptr) > 0) return {};
  const Setting& setting = rows.front()->setting;
  const report::AboutSuite about = report::about_suite(setting.suite);
  BoardSteps steps;
  steps.arm = about.main_arm;
  steps.demonstrations = setting.demonstrations.back();
  if (about.main_demonstrations &&
      std::count(setting.demonstrations.begin(), setting.demonstrations.end(), *about.main_demonstrations) > 0)
    steps.demonstrations = *about.main_demonstrations;
  report::StageOutcomes outcomes{{}, {}, setting.shared_scenes()};
  for (const Entry* row : rows) outcomes.rates.push_back(rates_of(*row, steps.arm, steps.demonstrations));
  const std::size_t scenarios = outcomes.rates.front().size();
  if (scenarios == 0) return {};
  outcomes.weights.assign(scenarios, 1);
  for (std::size_t i = 0; i < steps.success.size(); ++i) steps.success[i] = report::mean_rate(outcomes, i);
  steps.steps = report::steps_of(outcomes, fmt::format("leaderboard/steps/{}/{}", hash(setting), setting.scene_seed));
  return steps;
}

report::Grid steps_grid(const BoardSteps& steps, const std::string& suite, const std::string& name) {
  report::Grid grid;
  grid.name = name;
  grid.caption = fmt::format("Success in {}, {} demonstrations, and what each row adds to the one above it",
                             Titles(suite).arm(steps.arm), steps.demonstrations);
  grid.heads = {"told", "row", "success", "added", "these scenarios", "other scenarios too"};
  grid.align = "llrrll";
  for (std::size_t i = 0; i < stages.size(); ++i) {
    report::Grid::Row row{{},
                          {report::Span(stages[i].what), report::Span(report::display_name(stages[i].method)),
                           report::Span::number(fixed(steps.success[i]))}};
    row.cells.resize(grid.heads.size());
    if (i > 0) {
      const report::Step& step = steps.steps[i - 1];
      row.cells[3] = report::Span::number(signed_text(step.difference), "", report::Emphasis::strong);
      row.cells[4] = report::Span::number(report::signed_interval(step.interval));
      row.cells[5] = report::Span::number(report::signed_interval(step.over_commands));
    }
    grid.rows.push_back(std::move(row));
  }
  return grid;
}

}  // namespace lgabench::leaderboard
