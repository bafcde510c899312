#include <lgabench/leaderboard/board_steps.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/rounding.hpp>
#include <lgabench/leaderboard/titles.hpp>
#include <lgabench/leaderboard/units.hpp>
#include <lgabench/statistics/names.hpp>

namespace lgabench::leaderboard {
namespace {

using statistics::both_stage;
using statistics::command_read;
using statistics::stages;
using statistics::true_mask;

bool has_each_of(const Json& options, const Json& some) {
  return std::all_of(some.items().begin(), some.items().end(), [&](const auto& option) {
    return options.contains(option.key()) && options[option.key()] == option.value();
  });
}

using StageRows = std::array<const Entry*, stages.size()>;

// The row of each stage with the options of the truth's, which has all that the others have; nullptr where there is
// none.
StageRows rows_of(const std::vector<Standing>& table, const std::string& frozen) {
  StageRows rows{};
  const auto has_frozen = [&](const Entry* entry) { return entry && to_string(entry->identity.answers) == frozen; };
  for (std::size_t i = stages.size(); i-- > 0;)
    for (const Standing& s : table) {
      const Competitor& row = s.entry->identity.row;
      // The labels' rules mask scene by scene, which a row that selects alone cannot hand to another's policy.
      const bool selects = row.acts && row.acts->id == "lga" && (row.id == command_read || row.id == true_mask);
      if (row.id == stages[i].method && !row.is_reference() && s.entry->identity.conditions.none() &&
          (!row.acts || selects) && policy_of(*s.entry) == "heat_map" && answers_file(s.entry->identity).empty() &&
          (has_frozen(s.entry) || !has_frozen(rows[i])) &&
          (!rows.back() || has_each_of(rows.back()->identity.row.options, row.options)))
        rows[i] = s.entry;
    }
  return rows;
}

// Leaves one rule of labels: the one that is named, or else counted.
void leave_one_rule(StageRows& rows, const Track& track, int demonstrations) {
  const auto named = track.labels.find(demonstrations);
  const bool by_meaning = rows[2] && named != track.labels.end() && named->second == stages[2].method;
  rows[by_meaning ? 1 : 2] = nullptr;
}

bool lacks_any(const StageRows& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (!rows[i] && stages[i].needed && i != 1) return true;
  return !rows[1] && !rows[2];
}

std::string success_of(const BoardSteps& steps) {
  return statistics::capital(success_word(steps.played.front().entry->setting));
}

// The success of the best row that is not told the truth, in that column.
double best_of(const std::vector<Standing>& table, const MainColumn& column) {
  double best = 0;
  for (const Standing& s : table) {
    if (s.entry->identity.row.id == true_mask || s.entry->identity.row.is_reference()) continue;
    const Rates rates = rates_of(*s.entry, column.arm, column.demonstrations);
    if (rates.empty()) continue;
    best = std::max(best, statistics::mean_rate({{rates}, std::vector<double>(rates.size(), 1), true}, 0));
  }
  return best;
}

}  // namespace

const BoardSteps::Played* BoardSteps::of(const char* method) const {
  const auto found = std::find_if(played.begin(), played.end(), [method](const Played& one) {
    return std::string_view(one.stage->method) == method;
  });
  return found == played.end() ? nullptr : &*found;
}

std::optional<BoardSteps> steps_of(const std::vector<Standing>& table, const Track& track,
                                   const std::optional<Undisputed>& undisputed, std::optional<int> demonstrations) {
  StageRows rows = rows_of(table, track.answers);
  if (!rows.front()) return {};
  const Setting& setting = rows.front()->setting;
  BoardSteps steps;
  steps.column = main_column(setting);
  const auto has_main = [&](const Setting::Scenario& one) { return contains(one.arms, steps.column.arm); };
  if (!track.arms.empty() && std::none_of(setting.scenarios.begin(), setting.scenarios.end(), has_main))
    steps.column.arm = track.arms.front();  // the suite's main arm is another preset's
  if (demonstrations) steps.column.demonstrations = *demonstrations;
  leave_one_rule(rows, track, steps.column.demonstrations);
  if (lacks_any(rows)) return {};
  statistics::StageOutcomes outcomes{{}, {}, setting.shared_scenes()};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i]) continue;
    outcomes.rates.push_back(rates_of(*rows[i], steps.column.arm, steps.column.demonstrations));
    steps.played.push_back({&stages[i], rows[i], 0, {}});
  }
  steps.scenarios = outcomes.rates.front().size();
  if (steps.scenarios == 0) return {};
  outcomes.weights.assign(steps.scenarios, 1);
  for (std::size_t i = 0; i < steps.played.size(); ++i) {
    BoardSteps::Played& one = steps.played[i];
    one.success = statistics::mean_rate(outcomes, i);
    if (undisputed) one.undisputed = success(*undisputed, *one.entry);
  }
  const std::string name = fmt::format("leaderboard/steps/{}/{}", hash(setting), setting.scene_seed);
  steps.steps = statistics::steps_of(outcomes, name);
  steps.read = steps.steps[1];
  if (steps.of(both_stage))
    steps.both =
        statistics::steps_of({{outcomes.rates[1], outcomes.rates[3]}, outcomes.weights, outcomes.shared}, name).front();
  steps.best = best_of(table, steps.column);
  return steps;
}

document::Grid steps_grid(const BoardSteps& steps, const std::string& suite, const std::string& name) {
  document::Grid grid;
  grid.name = name;
  grid.caption =
      fmt::format("{} in {}, {} scenarios, {} demonstrations, and what each row adds to the one above it",
                  success_of(steps), Titles(suite).arm(steps.column.arm), steps.scenarios, steps.column.demonstrations);
  for (std::size_t i = 0; i < steps.played.size(); ++i) {
    const BoardSteps::Played& one = steps.played[i];
    grid.rows.emplace_back();
    put(grid, "told", 'l', document::Span(one.stage->what));
    put(grid, "row", 'l',
        document::Span(statistics::display_name(
            one.stage->method == std::string_view(true_mask) ? statistics::true_mask_row : one.stage->method)));
    put(grid, "success", 'r', document::Span::number(fixed(one.success)));
    if (steps.played.front().undisputed)
      put(grid, "undisputed", 'r', document::Span::number(fixed(one.undisputed.value_or(0))));
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

document::Grid curve_grid(const std::vector<BoardSteps>& curve, const std::string& suite, const std::string& name) {
  document::Grid grid;
  grid.name = name;
  grid.caption = fmt::format(
      "{} in {} after so many demonstrations, {} scenarios; brackets: 95 % intervals over other "
      "scenarios too",
      success_of(curve.front()), Titles(suite).arm(curve.front().column.arm), curve.front().scenarios);
  const auto added = [](const statistics::Step& step) {
    return document::Span::number(
        fmt::format("{} {}", signed_text(step.difference), statistics::signed_interval(step.over_commands)));
  };
  for (const BoardSteps& one : curve) {
    grid.rows.emplace_back();
    put(grid, "demonstrations", 'r', document::Span::number(std::to_string(one.column.demonstrations)));
    put(grid, "pixels", 'r', document::Span::number(fixed(one.played.front().success)));
    put(grid, "labels", 'r', document::Span::number(fixed(one.labels().success)));
    put(grid, "their rule", 'l', document::Span(one.labels().stage->what));
    put(grid, "command read", 'r', document::Span::number(fixed(one.of(command_read)->success)));
    const BoardSteps::Played* const both = one.of(both_stage);
    put(grid, "both", 'r', both ? document::TableCell(document::Span::number(fixed(both->success))) : "–");
    put(grid, "true mask", 'r', document::Span::number(fixed(one.of(true_mask)->success)));
    put(grid, "reading the command adds", 'l', added(one.read));
    put(grid, "both add", 'l', both ? document::TableCell(added(one.both)) : "–");
  }
  return grid;
}

}  // namespace lgabench::leaderboard
