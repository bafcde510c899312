#include <lgabench/leaderboard/overview.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/rounding.hpp>
#include <lgabench/leaderboard/areas.hpp>
#include <lgabench/leaderboard/titles.hpp>
#include <lgabench/leaderboard/units.hpp>
#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/bootstrap.hpp>

namespace lgabench::leaderboard {
namespace {

using document::Grid;
using document::Paragraph;
using document::reading;
using document::Span;

// The arms of a preset, in the order in which its scenarios name them.
std::vector<std::string> arms_of(const Setting& setting) {
  std::vector<std::string> arms;
  for (const Setting::Scenario& scenario : setting.scenarios)
    for (const std::string& arm : scenario.arms)
      if (!contains(arms, arm)) arms.push_back(arm);
  return arms;
}

// Its row says nothing.
bool is_oracle_that_always_succeeds(const Standing& s) {
  return s.entry->identity.row.id == "oracle" &&
         std::all_of(s.in_arm.begin(), s.in_arm.end(), [](const auto& arm) { return arm.second > .995; });
}

double mean_of(const Rates& rates) {
  double sum = 0;
  for (const auto& policies : rates)
    for (const std::vector<double>& scenes : policies)
      sum += statistics::mean(scenes) / static_cast<double>(policies.size() * rates.size());
  return sum;
}

// A row's mean over scenarios with its interval, of each row.
std::vector<std::string> with_intervals(const NamedTable& table, const std::string& arm, int n) {
  std::vector<Rates> rates;
  for (const Standing& s : table.standings) rates.push_back(rates_of(*s.entry, arm, n));
  const statistics::SharedResamples resamples(rates, table.setting.shared_scenes(),
                                              fmt::format("leaderboard/results/{}/{}/{}", hash(table.setting), arm, n));
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const statistics::Interval interval = resamples.interval(i);
    texts.push_back(fmt::format("{} [{}, {}]", fixed(mean_of(rates[i])), fixed(interval.low), fixed(interval.high)));
  }
  return texts;
}

std::vector<std::string> means_of(const NamedTable& table, const std::string& arm, int n) {
  std::vector<std::string> means;
  for (const Standing& s : table.standings) means.push_back(fixed(mean_of(rates_of(*s.entry, arm, n))));
  return means;
}

// Each row's name, with its policy and answers unless the table above has them, and no number yet.
Grid named_grid(const NamedTable& table, const std::string& suffix, const std::string& caption, bool repeated) {
  Grid grid = grid_of(table, suffix, statistics::capital(success_word(table.setting)) + caption);
  for (const NamedStanding& s : table.standings) {
    add_row(grid, s);
    put(grid, "method", 'l', Span(s.label));
    if (repeated) continue;
    put(grid, "policy", 'l', Span(s.policy));
    put(grid, "answers", 'l', Span(answers_label(*s.entry)));
  }
  return grid;
}

void add_column(Grid& grid, const std::string& head, const std::vector<std::string>& texts) {
  grid.heads.emplace_back(head);
  grid.align += 'r';
  for (std::size_t i = 0; i < texts.size(); ++i) grid.rows[i].cells.emplace_back(Span::number(texts[i]));
}

// Success in one arm at each number of demonstrations.
Grid numbers_grid(const NamedTable& table, const std::string& arm) {
  Grid grid = named_grid(table, "_demonstrations",
                         fmt::format(" in {}, by demonstrations", Titles(table.setting.suite).arm(arm)), false);
  for (const int number : table.setting.demonstrations)
    add_column(grid, std::to_string(number), with_intervals(table, arm, number));
  return grid;
}

// Success in every arm at one number of demonstrations, with intervals in the main arm.
Grid arms_grid(const NamedTable& table, const std::vector<std::string>& arms, const std::string& main, int n,
               bool repeated) {
  const Titles titles(table.setting.suite);
  Grid grid =
      named_grid(table, "_arms", fmt::format(" in every arm, {} demonstration{}", n, n == 1 ? "" : "s"), repeated);
  for (const std::string& arm : arms)
    add_column(grid, titles.arm(arm), arm == main ? with_intervals(table, arm, n) : means_of(table, arm, n));
  return grid;
}

// Markdown shows no captions.
void add_captioned(document::Section& section, Grid grid) {
  section.add<Paragraph>(reading, {{grid.caption + ":"}});
  section.add<Grid>(reading, std::move(grid));
}

// What the row of a suite's table says at one number of demonstrations.
Grid::Row steps_row(const NamedTable& table, const BoardSteps& steps) {
  const Titles titles(table.setting.suite);
  Grid::Row row{
      {},
      {Span::link(titles.suite(), "results/" + table.setting.suite + ".md"),
       Span(titles.arm(steps.column.arm) + (table.setting.paired() ? ", paired success" : "")),
       Span::number(std::to_string(steps.scenarios)), Span::number(std::to_string(steps.column.demonstrations))}};
  const auto add = [&](const std::optional<double>& success) {
    row.cells.push_back(success ? document::TableCell(Span::number(fixed(*success))) : "–");
  };
  const BoardSteps::Played &truth = *steps.of(statistics::true_mask), &read = *steps.of(statistics::command_read);
  const BoardSteps::Played* const both = steps.of(statistics::both_stage);
  add(steps.played.front().success);
  add(steps.labels().success);
  add(read.success);
  add(both ? std::optional(both->success) : std::nullopt);
  add(truth.success);
  row.cells.emplace_back(Span::number(
      fmt::format("{} {}", signed_text(steps.read.difference), statistics::signed_interval(steps.read.interval))));
  row.cells.emplace_back(Span::number(statistics::signed_interval(steps.read.over_commands)));
  row.cells.emplace_back(Span::number(signed_text(truth.success - steps.best)));
  add(table.undisputed ? read.undisputed : read.success);
  return row;
}

}  // namespace

void add_results(document::Section& section, NamedTable table, const fs::path& board) {
  const Setting& setting = table.setting;
  auto& rows = table.standings;
  rows.erase(std::remove_if(rows.begin(), rows.end(), is_oracle_that_always_succeeds), rows.end());
  section.add<Paragraph>(
      reading,
      {{what_was_played(setting) + " Ranks, arms and episodes: ",
        Span::link(Titles(setting.suite).suite(), (board / (setting.suite + ".html")).generic_string()), "."}});
  if (table.standings.empty()) return;
  const bool has_curve = !table.curve.empty();
  if (has_curve) {
    add_captioned(section, curve_grid(table.curve, setting.suite, setting.name() + "_curve"));
  } else if (table.steps) {
    add_captioned(section, steps_grid(*table.steps, setting.suite, setting.name() + "_steps"));
    if (table.undisputed) section.add<Paragraph>(reading, {{words_of(*table.undisputed)}});
  }
  const std::vector<std::string> arms = arms_of(setting);
  auto [arm, n] = main_column(setting);
  if (!contains(arms, arm))  // a preset of before the suite had it
    arm = table.track.arms.empty() ? arms.back() : table.track.arms.front();
  const bool by_number = setting.demonstrations.size() > 1 || arms.size() == 1;
  if (by_number) add_captioned(section, numbers_grid(table, arm));
  if (!by_number || (has_curve && arms.size() > 1)) add_captioned(section, arms_grid(table, arms, arm, n, by_number));
}

Grid all_steps_grid(const Suites& suites) {
  Grid grid;
  grid.name = "steps";
  grid.caption = "Success by what one policy is told, in each suite's main arm";
  grid.heads = {"suite",
                "scenes",
                "scenarios",
                "n",
                "pixels",
                "labels",
                "command read",
                "both",
                "true mask",
                "reading the command adds",
                "other scenarios too",
                "left to win",
                "undisputed"};
  grid.align = "llrrrrrrrllrr";
  for (const auto& [suite, tables] : suites) {
    const bool has_curve =
        std::any_of(tables.begin(), tables.end(), [](const NamedTable& t) { return !t.curve.empty(); });
    for (const NamedTable& table : tables) {
      if (!table.steps || table.track.kind != Track::abstraction || (has_curve && table.curve.empty())) continue;
      if (!has_curve) grid.rows.push_back(steps_row(table, *table.steps));
      for (const BoardSteps& one : table.curve) grid.rows.push_back(steps_row(table, one));
    }
  }
  return grid;
}

}  // namespace lgabench::leaderboard
