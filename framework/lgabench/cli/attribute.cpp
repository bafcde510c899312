// lgabench attribute: causes of failures that a run left out, for a copy of it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include <lgabench/cli/help.hpp>
#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/recorded_run.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/recompute.hpp>
#include <lgabench/host/python_method.hpp>
#include <lgabench/record/cell_status.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/report/agreement.hpp>
#include <lgabench/report/results.hpp>

namespace lgabench::cli {
namespace {

struct AttributeArguments {
  fs::path run, out;
  Words rows, methods;
  int jobs = 0;  // 0: as many as there are cores
  double timeout_s = 3600;
  std::vector<fs::path> plugin_path;
  std::string python = "python3";
};

// Whether the cell has failures whose causes could be known, and are not.
bool lacks_causes(const Recorded& recorded) {
  if (recorded.cell.method.is_reference()) return false;
  const report::CellResult result = report::read_cell(recorded.directory);
  bool failed = false;
  for (const auto& [arm, episodes] : result.episodes)
    for (const Episode& episode : episodes) {
      if (!episode.attribution.empty()) return false;
      failed |= !episode.success();
    }
  return failed && std::all_of(result.commands.begin(), result.commands.end(),
                               [](const report::CommandResult& command) { return !command.quality.empty(); });
}

std::vector<Recorded> without_causes(const AttributeArguments& a, const RunRecord& record) {
  const Inventory inventory = take_stock(a.run, record);
  if (!inventory.edited.empty()) throw InputError(inventory.edited.front());
  std::set<std::string> rows;
  std::vector<Recorded> chosen;
  for (const Recorded& recorded : inventory.cells) {
    const std::string& row = recorded.cell.method.name;
    rows.insert(row);
    const bool wanted = a.rows.empty() || std::find(a.rows.begin(), a.rows.end(), row) != a.rows.end();
    if (wanted && lacks_causes(recorded)) chosen.push_back(recorded);
  }
  for (const std::string& row : a.rows)
    if (rows.count(row) == 0)
      throw InputError(fmt::format("{}: no row {}, the run has: {}", a.run.string(), row, fmt::join(rows, ", ")));
  return chosen;
}

// Row -> why its causes cannot be told: a cell that is another one now.
std::map<std::string, std::string> rows_that_differ(const std::vector<Recorded>& cells, const Recomputed& again) {
  std::map<std::string, std::string> why;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Recorded& recorded = cells[i];
    const fs::path& now = again.cells[i];
    const std::string title = recorded.cell.title();
    if (!has_status(now))
      why.emplace(recorded.cell.method.name, title + ": not computed");
    else if (const CellStatus status = read_cell_status(now); status.failed)
      why.emplace(recorded.cell.method.name, fmt::format("{} fails now: {}", title, status.reason));
    else if (report::compare_cells(recorded.directory, now, false).agreement != report::Agreement::identical)
      why.emplace(recorded.cell.method.name, title + ": not the recorded actions");
  }
  return why;
}

void take_causes(const fs::path& cell, const fs::path& from) {
  const std::string episodes = read_file(from / cell_file::episodes, Links::refused);
  write_file(cell / cell_file::episodes, episodes);
  CellStatus status = read_cell_status(cell);
  status.files[cell_file::episodes] = sha256(episodes);
  write_cell_status(cell, status);
}

int attribute(AttributeArguments a) {
  expect_run(a.run);
  if (a.out.empty())
    a.out = fs::path(fs::absolute(a.run / "").lexically_normal().parent_path().string() + "-attributed");
  if (fs::exists(fs::symlink_status(a.out))) throw InputError(a.out.string() + ": exists already");
  const RunRecord record = read_run_record(a.run);
  expect_same_version(a.run, record, "attribute");
  const std::vector<Recorded> cells = without_causes(a, record);
  if (cells.empty()) throw InputError(a.run.string() + ": every failure that can be attributed is");
  std::vector<Cell> again;
  for (const Recorded& recorded : cells) again.push_back(recorded.cell);
  RunPlan plan = plan_again(a.run, record, std::move(again), a.jobs, a.timeout_s);
  plan.command = "lgabench attribute";
  Catalogue catalogue = plugins_at(a.plugin_path, a.python);
  for (const std::string& method : a.methods) with_python_method(method, a.python, catalogue);
  const std::optional<Recomputed> recomputed = recompute(plan, catalogue);
  if (!recomputed) return interrupted;

  const std::map<std::string, std::string> differing = rows_that_differ(cells, *recomputed);
  for (const auto& [row, why] : differing) to_stderr("{}: left out: {}\n", row, one_line(why));
  fs::copy(a.run, a.out, fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (differing.count(cells[i].cell.method.name) == 0)
      take_causes(a.out / "cells" / cells[i].directory.filename(), recomputed->cells[i]);
  print_report(a.out, false);
  to_stderr("written to {}\n", a.out.string());
  return differing.empty() ? ok : regression;
}

}  // namespace

void add_attribute(CLI::App& app, int& exit) {
  auto a = std::make_shared<AttributeArguments>();
  CLI::App* verb = app.add_subcommand("attribute",
                                      "Attribute the failures of a finished run to the abstraction, perception or the "
                                      "policy, for rows where that was not done");
  verb->add_option("RUN", a->run, "The run's directory")->required();
  verb->add_option("--rows", a->rows, "Rows, by name, separated by commas (default: all rows without attribution)")
      ->delimiter(',');
  verb->add_option("--out", a->out, "The directory for the copy (default: RUN-attributed)");
  verb->add_option("--jobs", a->jobs, "Cells to compute at once (default: one per core)")->check(CLI::Range(1, 4096));
  verb->add_option("--timeout", a->timeout_s, "Seconds after which a cell is stopped and counts as failed")
      ->check(within(1, 1e7))
      ->capture_default_str();
  verb->add_option("--methods", a->methods, "Methods in Python, as FILE.py:Class; separate several with commas")
      ->delimiter(',');
  verb->add_option("--python", a->python, "The interpreter for plugins in Python")->capture_default_str();
  add_plugin_path(*verb, a->plugin_path, any_plugin);
  arrange(*verb, "", {{"RUN", "RUN"}, {"--rows", "ROW,..."}, {"--out", "DIR"}});
  arrange(*verb, "How cells are computed",
          {{"--jobs", "N"}, {"--timeout", "SECONDS"}, {"--methods", "FILE.py:CLASS,..."}, {"--python", "PROGRAM"}});
  verb->footer(
      "Example: lgabench attribute runs/q1-leaderboard --rows my_method\nIn the leaderboard's presets, a method that "
      "did not come with this installation is never told the truth, so its failures are not attributed. This command "
      "computes the cells again, in fresh processes that learn the truth at the end, and writes a copy of the run with "
      "the causes; it says first how long that will take. A row whose actions are not the recorded ones, bit for bit, "
      "is left out: exit 1. `leaderboard add` takes the original run.");
  verb->callback([a, &exit] { exit = attribute(*a); });
}

}  // namespace lgabench::cli
