#include <lgabench/cli/causes.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>

#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/statistics/agreement.hpp>
#include <lgabench/statistics/results.hpp>

namespace lgabench::cli {
namespace {

bool lacks_causes(const Recorded& recorded) {
  if (recorded.cell.method.is_reference()) return false;
  const statistics::CellResult result = statistics::read_cell(recorded.directory);
  bool failed = false;
  for (const auto& [arm, episodes] : result.episodes)
    for (const Episode& episode : episodes) {
      if (!episode.attribution.empty()) return false;
      failed |= !episode.success();
    }
  return failed && std::all_of(result.commands.begin(), result.commands.end(),
                               [](const statistics::CommandResult& command) { return !command.quality.empty(); });
}

// Why the causes of a cell cannot be told: it is another one now. "" where it is the same.
std::string difference(const Recorded& recorded, const fs::path& now) {
  const std::string title = recorded.cell.title();
  if (!has_status(now)) return title + ": not computed";
  if (const CellStatus status = read_cell_status(now); status.failed)
    return fmt::format("{} fails now: {}", title, status.reason);
  const bool same =
      statistics::compare_cells(recorded.directory, now, false).agreement == statistics::Agreement::identical;
  return same ? "" : title + ": not the same when computed again";
}

}  // namespace

std::vector<Recorded> without_causes(const std::vector<Recorded>& cells) {
  std::vector<Recorded> some;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(some), lacks_causes);
  return some;
}

std::string rows_of(const std::vector<Recorded>& cells) {
  std::set<std::string> rows;
  for (const Recorded& recorded : cells) rows.insert(recorded.cell.method.name);
  return fmt::format("{}", fmt::join(rows, ", "));
}

std::optional<Causes> find_causes(const std::vector<Recorded>& cells, RunPlan plan, const Catalogue& catalogue) {
  plan.cells.clear();
  for (const Recorded& recorded : cells) {
    plan.cells.push_back(recorded.cell);
    plan.costs.learn(recorded.cell, recorded_seconds(recorded.directory));
  }
  plan.strangers = Strangers::told_in_cells;
  plan.purpose = "finding the causes of failures of " + one_line(rows_of(cells));
  std::optional<Recomputed> again = recompute(plan, catalogue);
  if (!again) return std::nullopt;
  Causes causes{cells, std::move(*again), {}};
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (const std::string why = difference(cells[i], causes.again.cells[i]); !why.empty())
      causes.left_out.emplace(cells[i].cell.method.name, why);
  for (const auto& [row, why] : causes.left_out)
    to_stderr("{} is left out, its failures have no causes: {}\n", one_line(row), one_line(why));
  return causes;
}

void keep_causes(const Causes& causes, const RunDirectory& run) {
  for (std::size_t i = 0; i < causes.cells.size(); ++i) {
    if (causes.left_out.count(causes.cells[i].cell.method.name) != 0) continue;
    const std::string name = causes.cells[i].directory.filename();
    const fs::path cell = run.scratch(name);
    fs::copy(run.cell(name), cell, fs::copy_options::recursive | fs::copy_options::copy_symlinks);
    const std::string episodes = read_file(causes.again.cells[i] / cell_file::episodes, Links::refused);
    write_file(cell / cell_file::episodes, episodes);
    CellStatus status = read_cell_status(cell);
    status.files[cell_file::episodes] = sha256(episodes);
    write_cell_status(cell, status);
    run.keep(name);
  }
  run.sync();
}

}  // namespace lgabench::cli
