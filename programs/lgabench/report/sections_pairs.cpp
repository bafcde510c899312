// Two commands on one scene, both right; and how far episodes of several steps came.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>

#include <lgabench/report/sections.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::report {
namespace {

// A column, and what a row has there; empty for nothing.
struct PairColumn {
  const char* head;
  std::function<TableCell(const Row&)> cell;
};

TableCell rate_cell(const Row& row, const std::optional<Rate>& rate, const std::string& member) {
  if (!rate) return {};
  return with_interval(rate->share, rate->interval, place_of(row, member), {"/share", "/low", "/high"}, rate_text);
}

TableCell paired_cell(const Row& row) {
  if (!row.paired) return {};
  TableCell cell = rate_cell(row, *row.paired, "paired");
  cell.episodes = row.index;
  cell.rate = row.paired->share;
  return cell;
}

TableCell over_commands_cell(const Row& row) {
  if (!row.paired) return {};
  if (!row.paired->over_commands) return Span("undecided");
  const auto end = [&](double at, const char* member) {
    return Span::number(rate_text(at), place_of(row, std::string("paired/over_commands/") + member));
  };
  const Interval& interval = *row.paired->over_commands;
  return Spans{Span::number("["), end(interval.low, "low"), Span::number(", "), end(interval.high, "high"),
               Span::number("]")};
}

TableCell success_cell(const Row& row) {
  if (!row.success) return {};
  return Span::number(rate_text(*row.success), place_of(row, "success"));
}

// A column of the row's course.
template <class Cell>
PairColumn of_course(const char* head, Cell cell) {
  return {head, [cell](const Row& row) { return row.course ? cell(row, *row.course) : TableCell(); }};
}

const std::vector<PairColumn>& columns() {
  static const std::vector<PairColumn> all{
      {"both right", paired_cell},
      {"other commands too", over_commands_cell},
      {"each", success_cell},
      of_course("first take",
                [](const Row& row, const Course& of) { return rate_cell(row, of.first_take, "course/first_take"); }),
      of_course("progress",
                [](const Row& row, const Course& of) {
                  return Span::number(rate_text(of.progress), place_of(row, "course/progress"));
                }),
      of_course("too early",
                [](const Row& row, const Course& of) { return count_cell(row, "course/too_early", of.too_early); }),
      of_course("went on",
                [](const Row& row, const Course& of) { return count_cell(row, "course/went_on", of.went_on); }),
      of_course("right refusals",
                [](const Row& row, const Course& of) { return rate_cell(row, of.refusals, "course/refusals"); }),
      of_course("right takes",
                [](const Row& row, const Course& of) { return rate_cell(row, of.takings, "course/takings"); })};
  return all;
}

// The rows of the mean over scenarios in one arm, without columns that none has a value in.
Grid rows_grid(const Material& material, const Table& table, const std::string& arm, int n) {
  std::vector<const Row*> rows;
  for (const auto& ids : {table.methods(mean_scenario), table.references(mean_scenario)})
    for (const std::string& id : ids)
      if (const Row* row = table.find(arm, mean_scenario, id, n); row && (row->paired || row->course))
        rows.push_back(row);
  Grid grid;
  for (const Row* row : rows) {
    grid.rows.emplace_back();
    grid.rows.back().reference = row->is_reference();
    put(grid, "method", 'l', named(material, row->method));
    for (const PairColumn& column : columns())
      if (std::any_of(rows.begin(), rows.end(), [&](const Row* one) { return !column.cell(*one).spans.empty(); }))
        put(grid, column.head, 'r', column.cell(*row));
  }
  return grid;
}

// Of each pair of commands, every row's share.
Grid by_commands(const Material& material, const Table& table, const std::string& arm, int n) {
  Grid grid;
  grid.group_head = "commands of";
  grid.heads = {"method", "both right"};
  grid.align = "llr";
  std::vector<std::string> commands;
  for (const Row& row : table.rows)
    if (row.is_mean() && row.arm == arm && row.demonstrations == n && row.paired)
      for (const auto& item : row.paired->by_commands) append_unique(commands, item.first);
  for (const std::string& one : commands)
    for (const auto& ids : {table.methods(mean_scenario), table.references(mean_scenario)})
      for (const std::string& id : ids) {
        const Row* row = table.find(arm, mean_scenario, id, n);
        if (!row || !row->paired) continue;
        const auto& all = row->paired->by_commands;
        const auto found = std::find_if(all.begin(), all.end(), [&](const auto& item) { return item.first == one; });
        if (found == all.end()) continue;
        const std::string place = fmt::format("paired/by_commands/{}/share", found - all.begin());
        grid.rows.push_back({one,
                             {named(material, id), Span::number(rate_text(found->second), place_of(*row, place))},
                             row->is_reference()});
      }
  return grid;
}

}  // namespace

Section pairs(const Material& material) {
  Section section{"pairs", "Both commands of a pair, and how far episodes came"};
  bool paired = false;
  for (const Table& all_rows : material.summary.tables) {
    const Table table = all_rows.without_errors();
    for (const int n : table.demonstrations())
      for (const std::string& arm : table.arms) {
        const std::string where =
            fmt::format("{}, {}, {}", table.arm_title(arm), table.demonstrations_text(n), table.title());
        const std::string name = fmt::format("pairs_{}_{}_{}_{}", slug(table.layout), slug(table.engine), slug(arm), n);
        Grid grid = rows_grid(material, table, arm, n);
        if (grid.rows.empty()) continue;
        grid.name = name;
        grid.caption = fmt::format("{}; brackets: 95 % intervals", where);
        section.add(reading, std::move(grid));
        Grid commands = by_commands(material, table, arm, n);
        paired = paired || !commands.rows.empty();
        if (commands.rows.empty()) continue;
        commands.name = name + "_commands";
        commands.caption = fmt::format("Each pair of commands, {}", where);
        section.add(reading, std::move(commands), "Each pair of commands", "Each pair of commands:");
      }
  }
  if (section.blocks.empty()) return section;
  if (paired)
    section.add(reading,
                Paragraph{{"“Both right” is the share of scenes in which both commands of a pair end right; nothing "
                           "but command and judge differs between the two episodes. A policy that does not hear the "
                           "command acts alike in both, and has none. The interval is over scenes and training seeds; "
                           "“other commands too” is over pairs of commands as well, undecided below six."}});
  section.add(reading,
              Paragraph{{"“First take” is the share of episodes whose first take was right, where one was needed. "
                         "“Progress” is the share of the needed steps that were right before the first error; saying "
                         "rightly that nothing is left to do is one of them. “Too early” counts episodes that were "
                         "said to be done before they were, “went on” those that were done and not said to be. “Right "
                         "refusals” is success where nothing was to be taken, “right takes” where something was."}});
  return section;
}

}  // namespace lgabench::report
