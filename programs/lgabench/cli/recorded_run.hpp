// A run that is there, and its cells computed again: for `verify`, `attribute` and, at its end, `run`.
#pragma once
#include <string>
#include <vector>

#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/harness/run_suite.hpp>
#include <lgabench/host/python_environment.hpp>

namespace lgabench::cli {

struct Recorded {
  fs::path directory;
  Cell cell;
  Json build;  // what computed it
};

// What a run holds, sorted by key.
struct Inventory {
  std::vector<Recorded> cells;
  std::vector<std::string> edited;  // a line for each cell that is not what its worker wrote
  int failed = 0, not_played = 0;
};
Inventory take_stock(const fs::path& run, const RunRecord& record);

/// The run of a command that computes its cells again, and with what.
struct RecomputeArguments {
  fs::path run;
  int jobs = 0;  // 0: as many as there are cores
  double timeout_s = 3600;
  Words methods;
  std::vector<fs::path> plugin_path;
  std::string python = usual_python();

  /// The plugins. @throws PluginError
  Catalogue catalogue() const;
};
/// --methods and --python.
void add_methods_in_python(Verb& verb, RecomputeArguments& a);

/// @throws InputError where no run is, and for one of a version that computes other cells; says to `verb` it with that.
RunRecord record_to_recompute(const fs::path& run, const std::string& verb);

/// The plan for recompute(): the cells with the run's answers. No server is asked. @throws InputError where these are
/// not kept with the run.
RunPlan plan_again(const fs::path& run, const RunRecord& record, std::vector<Cell> cells, int jobs, double timeout_s);

}  // namespace lgabench::cli
