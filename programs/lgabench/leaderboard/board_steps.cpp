#include <lgabench/leaderboard/board_steps.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/rounding.hpp>
#include <lgabench/leaderboard/titles.hpp>
#include <lgabench/statistics/names.hpp>

namespace lgabench::leaderboard {
namespace {

using statistics::stages;

bool has_each_of(const Json& options, const Json& some) {
  return std::all_of(some.items().begin(), some.items().end(), [&](const auto& option) {
    return options.contains(option.key()) && options[option.key()] == option.value();
  });
}

// The row of each stage with the options of the truth's, which has all that the others have; nullptr where there is
// none.
std::array<const Entry*, stages.size()> rows_of(const std::vector<Standing>& table, const std::string& frozen) {
  std::array<const Entry*, stages.size()> rows{};
  const auto has_frozen = [&](const Entry* entry) { return entry && to_string(entry->identity.answers) == frozen; };
  for (std::size_t i = stages.size(); i-- > 0;)
    for (const Standing& s : table) {
      const Competitor& row = s.entry->identity.row;
      // The labels' rule masks scene by scene, which a row that selects alone cannot hand to another's policy.
      if (row.id == stages[i].method && !row.is_reference() && s.entry->identity.conditions.none() &&
          (!row.acts || (i >= 2 && row.acts->id == "lga")) && policy_of(*s.entry) == "heat_map" &&
          answers_file(s.entry->identity).empty() && (has_frozen(s.entry) || !has_frozen(rows[i])) &&
          (!rows.back() || has_each_of(rows.back()->identity.row.options, row.options)))
        rows[i] = s.entry;
    }
  return rows;
}

}  // namespace

std::optional<BoardSteps> steps_of(const std::vector<Standing>& table, const std::string& frozen,
                                   const std::optional<Undisputed>& undisputed) {
  const std::array<const Entry*, stages.size()> rows = rows_of(table, frozen);
  if (std::count(rows.begin(), rows.end(), nullptr) > 0) return {};
  const Setting& setting = rows.front()->setting;
  BoardSteps steps;
  steps.main = main_column(setting);
  statistics::StageOutcomes outcomes{{}, {}, setting.shared_scenes()};
  for (const Entry* row : rows) outcomes.rates.push_back(rates_of(*row, steps.main.arm, steps.main.demonstrations));
  const std::size_t scenarios = outcomes.rates.front().size();
  if (scenarios == 0) return {};
  outcomes.weights.assign(scenarios, 1);
  for (std::size_t i = 0; i < steps.success.size(); ++i) {
    steps.success[i] = statistics::mean_rate(outcomes, i);
    if (undisputed) steps.undisputed[i] = success(*undisputed, *rows[i]);
  }
  steps.steps =
      statistics::steps_of(outcomes, fmt::format("leaderboard/steps/{}/{}", hash(setting), setting.scene_seed));
  return steps;
}

document::Grid steps_grid(const BoardSteps& steps, const std::string& suite, const std::string& name) {
  document::Grid grid;
  grid.name = name;
  grid.caption = fmt::format("Success in {}, {} demonstrations, and what each row adds to the one above it",
                             Titles(suite).arm(steps.main.arm), steps.main.demonstrations);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    grid.rows.emplace_back();
    put(grid, "told", 'l', document::Span(stages[i].what));
    put(grid, "row", 'l', document::Span(statistics::display_name(stages[i].method)));
    put(grid, "success", 'r', document::Span::number(fixed(steps.success[i])));
    if (steps.undisputed.front())
      put(grid, "undisputed", 'r', document::Span::number(fixed(steps.undisputed[i].value_or(0))));
    std::array<document::TableCell, 3> added;  // nothing in the first row
    if (i > 0) {
      const statistics::Step& step = steps.steps[i - 1];
      added = {document::Span::number(signed_text(step.difference), "", document::Emphasis::strong),
               document::Span::number(statistics::signed_interval(step.interval)),
               document::Span::number(statistics::signed_interval(step.over_commands))};
    }
    put(grid, "added", 'r', added[0]);
    put(grid, "these scenarios", 'l', added[1]);
    put(grid, "other scenarios too", 'l', added[2]);
  }
  return grid;
}

}  // namespace lgabench::leaderboard
