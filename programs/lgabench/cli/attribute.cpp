// lgabench attribute: causes of failures that a run left out, for a copy of it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <set>

#include <lgabench/cli/causes.hpp>
#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/directories.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench::cli {
namespace {

struct AttributeArguments : RecomputeArguments {
  fs::path out;
  Words rows;
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
    if (a.rows.empty() || contains(a.rows, row)) chosen.push_back(recorded);
  }
  for (const std::string& row : a.rows)
    if (rows.count(row) == 0)
      throw InputError(fmt::format("{}: no row {}, the run has: {}", a.run.string(), row, fmt::join(rows, ", ")));
  return without_causes(chosen);
}

int attribute(AttributeArguments a) {
  const RunRecord record = record_to_recompute(a.run, "attribute");
  if (a.out.empty())
    a.out = fs::path(fs::absolute(a.run / "").lexically_normal().parent_path().string() + "-attributed");
  if (fs::exists(fs::symlink_status(a.out))) throw InputError(a.out.string() + ": exists already");
  if (a.out.has_parent_path()) make_directories(a.out.parent_path());
  const std::vector<Recorded> cells = wanted_cells(a, record);
  if (cells.empty()) throw InputError(a.run.string() + ": every failure that can be attributed has its cause");
  RunPlan plan = plan_again(a.run, record, {cells.front().cell}, a.jobs, a.timeout_s);
  plan.command = "lgabench attribute";
  const std::optional<Causes> causes = find_causes(cells, plan, a.catalogue());
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
  Verb verb(app, "attribute",
            "Attribute the failures of a finished run to the abstraction, perception or the "
            "policy, for rows without attribution");
  verb.option("RUN", a->run, "The run's directory", required);
  verb.option("--rows ROW,...", a->rows, "Rows, by name, separated by commas (default: all rows without attribution)");
  verb.option("--out DIR", a->out, "The directory for the copy (default: RUN-attributed)");
  add_plugin_path(verb, a->plugin_path, any_plugin);
  add_scenario_path(verb);
  verb.below("How cells are computed");
  add_pool(verb, a->jobs, a->timeout_s);
  add_methods_in_python(verb, *a);
  verb->footer(
      "Example: lgabench attribute runs/q1-leaderboard --rows my_method\nIn the leaderboard's presets and in parts of "
      "a run, a method that did not come with this installation is not told the truth, so its failures are not "
      "attributed. This command computes the cells again, in fresh processes that learn the truth at the end, and "
      "writes a copy of the run with the causes; it first prints how long that will take. A row whose actions are not "
      "bit-identical to the recorded ones is left out: exit 1. Give `leaderboard add` the original run.");
  verb->callback([a, &exit] { exit = attribute(*a); });
}

}  // namespace lgabench::cli
