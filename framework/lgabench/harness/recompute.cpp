#include <lgabench/harness/recompute.hpp>

namespace lgabench {

std::optional<Recomputed> recompute(RunPlan plan, const Catalogue& catalogue) {
  const auto scratch = std::make_shared<const Scratch>("verify");
  plan.out = scratch->path / "run";
  if (plan.cache.empty()) plan.cache = scratch->path / "cache";
  if (run_suite(plan, catalogue).interrupted) return std::nullopt;
  Recomputed now{scratch, read_run_record(plan.out), {}};
  for (const Cell& cell : plan.cells) now.cells.push_back(plan.out / "cells" / key(cell));
  return now;
}

}  // namespace lgabench
