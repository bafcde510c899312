// Cells that were played before, computed again: for `verify`, for causes of failures, and for the leaderboard.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <lgabench/core/scratch.hpp>
#include <lgabench/harness/run_suite.hpp>

namespace lgabench {

/// Finished or failed cells in a temporary directory, which is gone with the last copy.
struct Recomputed {
  std::shared_ptr<const Scratch> scratch;
  RunRecord record;                          // what computed them here
  std::vector<std::filesystem::path> cells;  // directories, in the plan's order
};

/// Plays the plan's cells, on its cache or, where it names none, on an empty one; where the plan says that a run is has
/// no influence. None where it was interrupted. @throws InputError and PluginError as run_suite().
std::optional<Recomputed> recompute(RunPlan plan, const Catalogue& catalogue);

}  // namespace lgabench
