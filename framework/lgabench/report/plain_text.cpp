#include <fmt/format.h>

#include <algorithm>

#include <lgabench/report/names.hpp>
#include <lgabench/report/settings.hpp>
#include <lgabench/report/tables.hpp>

namespace lgabench::report {
namespace {

std::size_t display_width(const std::string& text) {  // of UTF-8 without wide or combining characters
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, display_width(text)), ' ');
}

// Columns of `text_of` for every method of `scenarios`, under `corner`.
std::string block(const Table& table, const std::string& corner, const std::vector<Column>& columns,
                  std::string (*text_of)(const Row*), const std::vector<std::string>& scenarios) {
  std::size_t first = corner.size() - 2, wide = 0;  // the corner has no indent
  for (const Row& row : table.rows) {
    first = std::max(first, display_width(display_name(row.method)));
    wide = std::max(wide, display_width(text_of(&row)));
  }
  for (const Column& column : columns) wide = std::max(wide, display_width(column.head));
  first += 4, wide += 2;  // the indent and the gaps between columns

  std::string text;
  const auto add = [&text](std::string row) { text += row.erase(row.find_last_not_of(' ') + 1) + '\n'; };
  std::string head = padded(corner, first);
  for (const Column& column : columns) head += padded(column.head, wide);
  add(head);
  const auto line = [&](const std::string& scenario, const std::string& id) {
    std::string row = padded("  " + display_name(id), first);
    for (const Column& c : columns) row += padded(text_of(table.find(c.arm, scenario, id, c.demonstrations)), wide);
    add(row);
  };
  for (const std::string& scenario : scenarios) {
    text += '\n' + table.title(scenario) + '\n';
    for (const std::string& id : table.methods(scenario)) line(scenario, id);
    if (!table.references(scenario).empty()) text += "  " + std::string(first + wide * columns.size() - 4, '-') + '\n';
    for (const std::string& id : table.references(scenario)) line(scenario, id);
  }
  return text;
}

}  // namespace

std::string plain_text(const RunResults& run, const Summary& summary) {
  std::string text;
  for (const std::string& line : settings(run)) text += fmt::format("{}: {}\n", summary.suite, line);
  if (!text.empty()) text += '\n';
  for (const Table& table : summary.tables)
    for (const View& view : views(table)) {
      text += fmt::format("{}, {}: success [95 % interval over test scenes and training seeds]\n\n{}\n", summary.suite,
                          table.title(), block(table, view.corner, view.columns, success_text, table.scenarios()));
      if (!view.shifted.empty())
        text += fmt::format("{}, {}: change against {} [95 % interval]\n\n{}\n", summary.suite, table.title(),
                            table.arms.front(), block(table, view.corner, view.shifted, shift_text, table.scenarios()));
      if (any_seen(table))
        text += fmt::format("{}, {}: test inputs seen in training, share\n\n{}\n", summary.suite, table.title(),
                            block(table, view.corner, view.columns, seen_text, {mean_scenario}));
    }
  for (const std::string& note : notes(run, summary)) text += note + '\n';
  for (const std::string& line : method_errors(run, run.directory)) text += line + '\n';
  for (const CellResult& cell : summary.failed)
    text += fmt::format("failed: {} {} {} {} n={} seed={} ({}): {}\n", cell.method, cell.scenario, cell.layout,
                        cell.engine, cell.demonstrations, cell.training_seed, cell.fault, cell.reason);
  return text;
}

}  // namespace lgabench::report
