// The processor cores and the memory that this process may use: the job's, not the machine's.
#pragma once
#include <limits>

#include <lgabench/core/files.hpp>

namespace lgabench {

/// What limits a job; infinite where nothing does.
struct JobLimits {
  double cores = std::numeric_limits<double>::infinity();  // a share of one likewise
  double bytes = std::numeric_limits<double>::infinity();  // of memory
};

/// Limits of this process's control groups, of either version, and of those above them. `root`: where /proc and the
/// groups lie.
JobLimits cgroup_limits(const fs::path& root = "/");
/// What Slurm says that the job has, by its variables.
JobLimits slurm_limits();

/// Whole cores, 1 or more: the least of processor affinity, control groups (rounded up) and Slurm's variables, as they
/// were at the first call.
int usable_cores();
/// Bytes of memory: the least of the machine's, control groups and Slurm's variables, likewise.
double usable_bytes();

}  // namespace lgabench
