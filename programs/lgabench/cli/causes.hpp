// Causes of failures that a run lacks: for `run`, once all is scored, and `attribute`.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/cli/recorded_run.hpp>
#include <lgabench/harness/recompute.hpp>
#include <lgabench/harness/run_directory.hpp>

namespace lgabench::cli {

/// The cells that have failures whose causes could be known, and are not. @throws InputError for a cell that
/// cannot be read.
std::vector<Recorded> without_causes(const std::vector<Recorded>& cells);

/// The rows of the cells, by name, separated by commas.
std::string rows_of(const std::vector<Recorded>& cells);

struct Causes {
  std::vector<Recorded> cells;                  // as they are in the run
  Recomputed again;                             // the same, with causes
  std::map<std::string, std::string> left_out;  // row -> why: one of its cells fails now, or acts otherwise
};

/// Computes the cells again, each in a fresh process that is told the truth at its end, with the answers, workers and
/// cache of `plan`; says which rows are left out. None where it was interrupted. @throws as run_suite(). @pre not empty
std::optional<Causes> find_causes(const std::vector<Recorded>& cells, RunPlan plan, const Catalogue& catalogue);

/// Puts them into the run: of a cell nothing changes but its episodes' causes, and a kill leaves it as it was or will
/// be. @throws InputError where it cannot be written.
void keep_causes(const Causes& causes, const RunDirectory& run);

}  // namespace lgabench::cli
