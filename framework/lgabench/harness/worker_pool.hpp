// Runs lgabench-worker processes, a few at a time.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>
#include <lgabench/job/job.hpp>

namespace lgabench {

struct WorkerTask {
  Json job;                   // the worker's stdin
  std::filesystem::path log;  // its stdout and stderr
  std::string verb = "cell";  // of lgabench-worker
};

/// How a worker ended.
struct WorkerEnd {
  double seconds = 0;  // of wall time
  int exit_code = 0;
  int signal = 0;          // that ended it, or 0
  bool timed_out = false;  // it was stopped after the limit
  std::string phase;       // the last one it reported
  std::string waits_for;   // the plugin's process whose answer it awaited in the end, or ""
  std::optional<Complaint> complaint{};
};

struct PoolOptions {
  int jobs = 1;
  double timeout_s = 3600;  // of wall time, for one task; time in which this process was stopped, or the worker
                            // waited for others' questions (in_line_phase), does not count
  double memory_gib = 0;    // of data, for one task; 0: its share of usable_bytes(), 4 at least where the job has them
};

/// Called in the calling thread. `task` indexes the tasks.
struct PoolEvents {
  std::function<void(std::size_t task)> started;
  std::function<void(std::size_t task, const std::string& phase, long long count)> progress;
  std::function<void(std::size_t task, const WorkerEnd& end)> ended;
  std::function<void()> tick;  // about five times a second
};

/// Runs all tasks in order, `jobs` at once, each as a fresh process in its own process group that dies with this one.
/// A task's end, good or bad, changes nothing for the others. `make` is called just before a task starts.
/// @returns false if SIGINT, SIGTERM or SIGHUP came: all workers are then stopped and gone, and more of these signals
/// are ignored from there on.
/// A task that cannot be started waits for another to end where the system lacks processes, descriptors or memory; else
/// it has ended with that complaint. Uses the process's signal mask and children; one call
/// at a time.
bool run_workers(std::size_t tasks, const std::function<WorkerTask(std::size_t)>& make, const PoolOptions& options,
                 const PoolEvents& events);

/// Runs the cell of `job` on our own streams: what is typed is for the method's process alone (persons_input), an
/// interrupt too. Returns the worker's exit status.
int run_in_foreground(const Json& job);

/// What each of the workers may take.
Limits worker_limits(const PoolOptions& options);

/// "signal 11 (Segmentation fault) in phase learn": why a worker that did not finish ended, and that the plugin is at
/// fault ("plugin") or what came from outside ("host").
struct WorkerFault {
  std::string reason, fault;
};
WorkerFault why_it_ended(const WorkerEnd& end, double timeout_s);

/// The last 20 lines of a worker's log, cut to 400 characters, whatever was printed as ASCII.
std::vector<std::string> log_tail(const std::filesystem::path& log);

}  // namespace lgabench
