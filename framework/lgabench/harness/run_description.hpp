// What run.json says of a run before its first cell.
#pragma once
#include <optional>
#include <vector>

#include <lgabench/harness/run_suite.hpp>
#include <lgabench/record/run_record.hpp>

namespace lgabench {

/// The record of a run of all cells of the plan. @throws PluginError for a missing plugin.
RunRecord describe(const RunPlan& plan, const Catalogue& catalogue);

/// The part of the run that is computed now; none where that is all of it.
std::optional<RunRecord::Shard> shard_of(const RunPlan& plan);

/// The run's "answers".
Json answers_json(const std::vector<AnswerFile>& files);

}  // namespace lgabench
