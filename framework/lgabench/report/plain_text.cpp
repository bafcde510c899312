#include <fmt/format.h>

#include <algorithm>

#include <lgabench/report/names.hpp>
#include <lgabench/report/tables.hpp>

namespace lgabench::report {
namespace {

std::size_t display_width(const std::string& text) {  // of UTF-8 without wide or combining characters
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, display_width(text)), ' ');
}

std::string block(const Table& table) {
  const std::vector<int> columns = table.demonstrations();
  const std::string title = "demonstrations";
  std::size_t first = title.size() - 2, wide = 0;  // the title has no indent
  for (const Row& row : table.rows) {
    first = std::max(first, display_width(display_name(row.method)));
    wide = std::max(wide, display_width(success_text(&row)));
  }
  first += 4, wide += 2;  // the indent and the gaps between columns

  std::string text;
  const auto add = [&text](std::string row) { text += row.erase(row.find_last_not_of(' ') + 1) + '\n'; };
  std::string head = padded(title, first);
  for (const int n : columns) head += padded(std::to_string(n), wide);
  add(head);
  const auto line = [&](const std::string& scenario, const std::string& id) {
    std::string row = padded("  " + display_name(id), first);
    for (const int n : columns) row += padded(success_text(table.find(scenario, id, n)), wide);
    add(row);
  };
  for (const std::string& scenario : table.scenarios()) {
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
  for (const Table& table : summary.tables)
    text += fmt::format("{}, {}: success [95 % interval]\n\n{}\n", summary.suite, table.title(), block(table));
  for (const std::string& note : notes(run, summary)) text += note + '\n';
  for (const CellResult& cell : summary.failed)
    text += fmt::format("failed: {} {} {} {} n={} seed={} ({}): {}\n", cell.method, cell.scenario, cell.layout,
                        cell.engine, cell.demonstrations, cell.training_seed, cell.fault, cell.reason);
  return text;
}

}  // namespace lgabench::report
