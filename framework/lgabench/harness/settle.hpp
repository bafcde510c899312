// Settles what a worker left: a cell's result, or why there is none.
#pragma once
#include <filesystem>
#include <string>

#include <lgabench/harness/run_directory.hpp>
#include <lgabench/harness/worker_pool.hpp>
#include <lgabench/record/cell.hpp>

namespace lgabench {

/// Accepts the cell in `scratch` if its files match the worker's checksums; otherwise leaves status.json, cell.json and
/// the log there alone. @returns the reason of a failure, or "".
std::string settle(const Cell& cell, const WorkerEnd& end, const std::filesystem::path& scratch, const Json& build,
                   double timeout_s);

/// A cell that could not be put in its place as it ended: without its files, or with none at all on a full disk, which
/// stderr says.
void record_failure(const RunDirectory& directory, const Cell& cell, const std::string& reason,
                    const std::string& fault, const Json& build);

}  // namespace lgabench
