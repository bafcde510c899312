// A run that is there, and its cells computed again: for `verify`, `attribute` and, at its end, `run`.
#pragma once
#include <string>
#include <vector>

#include <lgabench/harness/run_suite.hpp>

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

/// @throws InputError for a run of a version that computes other cells, and says to `verb` it with that.
void expect_same_version(const fs::path& run, const RunRecord& record, const std::string& verb);

/// For recompute(): the cells with the run's answers; no server is asked. @throws InputError where these are not kept
/// with the run.
RunPlan plan_again(const fs::path& run, const RunRecord& record, std::vector<Cell> cells, int jobs, double timeout_s);

}  // namespace lgabench::cli
