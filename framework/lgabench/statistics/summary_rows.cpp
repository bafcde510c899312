// What rows and tables say of themselves.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include <lgabench/statistics/summary.hpp>

#include <lgabench/core/contains.hpp>

namespace lgabench::statistics {

void append_unique(std::vector<std::string>& all, const std::string& one) {
  if (!contains(all, one)) all.push_back(one);
}

bool Row::marked(const std::string& mark) const { return contains(marks, mark); }

std::string Row::without_errors() const { return method.substr(0, method.size() - errors.suffix().size()); }

Table Table::without_errors() const {
  std::set<std::string> right;
  for (const Row& row : rows)
    if (row.errors.none()) right.insert(row.method);
  Table table = *this;
  const auto beside_its_own = [&right](const Row& row) {
    return !row.errors.none() && right.count(row.without_errors()) == 1;
  };
  table.rows.erase(std::remove_if(table.rows.begin(), table.rows.end(), beside_its_own), table.rows.end());
  return table;
}

std::vector<std::string> Table::scenarios() const {
  std::vector<std::string> all;
  for (const Row& row : rows)
    if (!row.is_mean()) append_unique(all, row.scenario);
  all.emplace_back(mean_scenario);
  return all;
}

std::vector<std::string> Table::scenarios_with(const std::string& arm) const {
  std::vector<std::string> all;
  for (const Row& row : rows)
    if (!row.is_mean() && row.arm == arm && !row.marked("ambiguous")) append_unique(all, row.scenario);
  return all;
}

bool Table::perturbs(const std::string& arm) const {
  return std::any_of(rows.begin(), rows.end(), [&arm](const Row& row) { return row.arm == arm && row.perturbation; });
}

std::vector<int> Table::demonstrations() const {
  std::set<int> learned, any;
  for (const Row& row : rows) {
    any.insert(row.demonstrations);
    if (row.demonstrations > 0) learned.insert(row.demonstrations);
  }
  const std::set<int>& columns = learned.empty() ? any : learned;
  return {columns.begin(), columns.end()};
}

std::string Table::demonstrations_text(int n) const {
  if (demonstrated_commands == 1) return fmt::format("{} demonstration{}", n, n == 1 ? "" : "s");
  if (demonstrated_commands == 0) return fmt::format("demonstrations: {} per command", n);
  return fmt::format("demonstrations: {} per command, {} in all", n, n * demonstrated_commands);
}

const Row* Table::find(const std::string& arm, const std::string& scenario, const std::string& method, int n) const {
  for (const Row& row : rows)
    if (row.arm == arm && row.scenario == scenario && row.method == method &&
        (row.demonstrations == n || (row.is_reference() && row.demonstrations == 0)))
      return &row;
  return nullptr;
}

std::vector<std::string> Table::ids(const std::string& scenario, const std::string& kind) const {
  std::vector<std::string> all;
  for (const Row& row : rows)
    if (row.scenario == scenario && row.kind == kind) append_unique(all, row.method);
  return all;
}

std::string Table::title(const std::string& scenario) const {
  if (scenario != mean_scenario) return scenario;
  const std::size_t n = scenarios().size() - 1;
  return fmt::format("mean over {} scenario{}", n, n == 1 ? "" : "s");
}

std::string Table::arm_title(const std::string& arm) const {
  const auto found = arm_titles.find(arm);
  return found == arm_titles.end() ? arm : found->second;
}

std::string Table::arm_head(const std::string& arm) const {
  const std::size_t with = scenarios_with(arm).size(), all = scenarios().size() - 1;
  return with == all ? arm_title(arm) : fmt::format("{} ({} of {})", arm_title(arm), with, all);
}

std::string Table::title() const { return fmt::format("layout {}, engine {}", layout, engine); }

}  // namespace lgabench::statistics
