#include <lgabench/report/brief.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include <lgabench/document/writers.hpp>
#include <lgabench/report/headline.hpp>
#include <lgabench/report/sections.hpp>

namespace lgabench::report {
namespace {

constexpr std::size_t most_methods = 8, most_columns = 80;  // rows; columns of a terminal

enum class Shown { intervals, rates, main_and_mean };

std::size_t width_of(const std::string& text) {
  std::size_t widest = 0, now = 0;
  for (const char c : text) {
    now = c == '\n' ? 0 : now + ((c & 0xC0) != 0x80);
    widest = std::max(widest, now);
  }
  return widest;
}

std::string success_text(const Row& row, bool interval) {
  if (!row.success) return "–";
  return fixed(*row.success) +
         (interval ? fmt::format(" [{}, {}]", fixed(row.interval.low), fixed(row.interval.high)) : "") +
         marks_text(row);
}

struct Means {
  const Material& material;
  const Table& table;
  const Column& main;
  std::set<std::string> marks{};  // of the rows that are shown

  std::vector<Column> columns() const {
    std::vector<Column> all;
    if (table.arms.size() == 1)
      for (const int n : table.demonstrations()) all.push_back({std::to_string(n), main.arm, n});
    else
      for (const std::string& arm : table.arms) all.push_back({table.arm_head(arm), arm, main.demonstrations});
    return all;
  }

  TableCell cell(const std::string& id, const Column& column, bool interval) {
    const Row* row = table.find(column.arm, mean_scenario, id, column.demonstrations);
    if (!row) return {};
    marks.insert(row->marks.begin(), row->marks.end());
    return success_text(*row, interval);
  }

  // Over columns in which the row has a value.
  TableCell mean(const std::string& id) const {
    double sum = 0;
    int n = 0;
    for (const Column& column : columns())
      if (const Row* row = table.find(column.arm, mean_scenario, id, column.demonstrations); row && row->success)
        sum += *row->success, ++n;
    return n == 0 ? "–" : fixed(sum / n);
  }

  Grid grid(const std::vector<std::string>& ids, Shown shown) {
    const std::vector<Column> all = columns();
    const bool one_arm = table.arms.size() == 1;
    Grid grid;
    grid.caption =
        fmt::format("Success, {}{}", table.title(mean_scenario), shown == Shown::rates ? "" : " [95 % interval]");
    if (material.summary.tables.size() > 1) grid.caption += ", " + table.title();
    grid.heads = {one_arm ? "demonstrations" : table.demonstrations_text(main.demonstrations)};
    if (shown == Shown::main_and_mean)
      grid.heads.insert(grid.heads.end(), {one_arm ? std::to_string(main.demonstrations) : table.arm_head(main.arm),
                                           fmt::format("mean of {}{}", all.size(), one_arm ? "" : " arms")});
    else
      for (const Column& column : all) grid.heads.emplace_back(column.head);
    for (const std::string& id : ids) {
      Grid::Row& row = grid.rows.emplace_back(Grid::Row{{}, {material.styles.name(id)}});
      row.reference = material.styles(id).reference();
      if (shown == Shown::main_and_mean)
        row.cells.insert(row.cells.end(), {cell(id, main, true), mean(id)});
      else
        for (const Column& column : all) row.cells.push_back(cell(id, column, shown == Shown::intervals));
    }
    return grid;
  }
};

}  // namespace

Brief brief(const Material& material) {
  Brief brief;
  const std::vector<Table>& tables = material.summary.tables;
  const Table table = tables.empty() ? Table() : tables.front().without_errors();
  if (const auto main = main_column(table, about_suite(material.run.suite, material.run.record.about))) {
    const std::vector<std::string> methods = table.methods(mean_scenario), references = table.references(mean_scenario),
                                   others = most_compared(methods, most_methods - 1);
    std::vector<std::string> ids;
    for (const std::string& id : methods)
      if (id == methods.front() || std::count(others.begin(), others.end(), id) > 0) ids.push_back(id);
    const std::size_t left_out = methods.size() - ids.size();
    for (const std::string& id : references)
      if (id == "constant_action" || id == "random_object") ids.push_back(id);
    for (const Shown shown : {Shown::intervals, Shown::rates, Shown::main_and_mean}) {
      Means means{material, table, *main};
      brief.means = means.grid(ids, shown);
      if (shown != Shown::main_and_mean && width_of(terminal(brief.means)) > most_columns) continue;
      for (const Mark& mark : table_marks)
        if (means.marks.count(mark.word) > 0) brief.notes.push_back(fmt::format("{} {}.", mark.sign, mark.meaning));
      break;
    }
    if (left_out > 0) brief.notes.push_back(fmt::format("More rows in the report: {}.", left_out));
    if (tables.size() > 1) brief.notes.push_back(fmt::format("More tables in the report: {}.", tables.size() - 1));
  }
  const std::vector<std::string> lacks = what_it_lacks(material.run);
  brief.notes.insert(brief.notes.end(), lacks.begin(), lacks.end());
  for (const MethodError& error : method_errors(material.run))
    brief.notes.push_back(fmt::format("{} ({})", error.text, (material.run.directory / error.log).string()));
  return brief;
}

}  // namespace lgabench::report
