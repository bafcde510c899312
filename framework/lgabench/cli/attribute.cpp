// lgabench attribute: causes of failures that a run left out, for a copy of it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <set>

#include <lgabench/cli/causes.hpp>
#include <lgabench/cli/help.hpp>
#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/host/python_method.hpp>

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

// Of the rows that are wanted. @throws InputError for a run that is not all played: what is told, is told after that.
std::vector<Recorded> wanted_cells(const AttributeArguments& a, const RunRecord& record) {
  const Inventory inventory = take_stock(a.run, record);
  if (!inventory.edited.empty()) throw InputError(inventory.edited.front());
  if (inventory.not_played != 0)
    throw InputError(
        fmt::format("{}: {} of its cells have not been played, expected a finished run: methods are told "
                    "the truth after the last cell",
                    a.run.string(), inventory.not_played));
  std::set<std::string> rows;
  std::vector<Recorded> chosen;
  for (const Recorded& recorded : inventory.cells) {
    const std::string& row = recorded.cell.method.name;
    rows.insert(row);
    if (a.rows.empty() || std::find(a.rows.begin(), a.rows.end(), row) != a.rows.end()) chosen.push_back(recorded);
  }
  for (const std::string& row : a.rows)
    if (rows.count(row) == 0)
      throw InputError(fmt::format("{}: no row {}, the run has: {}", a.run.string(), row, fmt::join(rows, ", ")));
  return without_causes(chosen);
}

int attribute(AttributeArguments a) {
  expect_run(a.run);
  if (a.out.empty())
    a.out = fs::path(fs::absolute(a.run / "").lexically_normal().parent_path().string() + "-attributed");
  if (fs::exists(fs::symlink_status(a.out))) throw InputError(a.out.string() + ": exists already");
  const RunRecord record = read_run_record(a.run);
  expect_same_version(a.run, record, "attribute");
  const std::vector<Recorded> cells = wanted_cells(a, record);
  if (cells.empty()) throw InputError(a.run.string() + ": every failure that can be attributed is");
  RunPlan plan = plan_again(a.run, record, {cells.front().cell}, a.jobs, a.timeout_s);
  plan.command = "lgabench attribute";
  Catalogue catalogue = plugins_at(a.plugin_path, a.python);
  for (const std::string& method : a.methods) with_python_method(method, a.python, catalogue);
  const std::optional<Causes> causes = find_causes(cells, plan, catalogue);
  if (!causes) return interrupted;
  fs::copy(a.run, a.out, fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  keep_causes(*causes, RunDirectory(a.out, record, Existing::same));
  print_report(a.out, Printed::end);
  print_page(a.out);
  return causes->left_out.empty() ? ok : regression;
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
      "Example: lgabench attribute runs/q1-leaderboard --rows my_method\nIn the leaderboard's presets and in parts of "
      "a run, a method that did not come with this installation is not told the truth, so its failures are not "
      "attributed. This command computes the cells again, in fresh processes that learn the truth at the end, and "
      "writes a copy of the run with the causes; it says first how long that will take. A row whose actions are not "
      "the recorded ones, bit for bit, is left out: exit 1. `leaderboard add` takes the original run.");
  verb->callback([a, &exit] { exit = attribute(*a); });
}

}  // namespace lgabench::cli
