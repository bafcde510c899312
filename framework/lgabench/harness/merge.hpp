// Parts of a run, or runs that differ in what they cross, put together.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/files.hpp>

namespace lgabench {

/// The cells that run.json asks for, as OUT holds them.
struct MergeOutcome {
  std::size_t finished = 0, failed = 0;
  std::size_t left_out = 0;  // damaged or of another build wherever they are
  std::size_t missing = 0;   // in none of the runs
};

/// Puts the cells of `runs` into `out`, a new directory or that of an earlier merge: of each cell a finished one,
/// where there is none a failed one. run.json is the first run's, with `command`, the earliest start, the confinement
/// of a run that was let out of it, and what the parts say of themselves under "merged". A cell that is damaged or of
/// another build is left out, and that is said on stderr, as are differing processors. Runs may have other methods,
/// scenarios, layouts, engines, numbers of demonstrations and seeds: `out` then has the cells of all.
/// @throws InputError with nothing written: naming what differs, where the runs have other settings or programs;
/// naming the cell, where two of them hold other results of one, or two cells that a table has one place for.
MergeOutcome merge_runs(const fs::path& out, const std::vector<fs::path>& runs, const std::string& command);

}  // namespace lgabench
