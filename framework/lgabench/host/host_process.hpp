// The process of a method, as the worker that starts it sees it. One thread.
#pragma once
#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <lgabench/host/confine.hpp>
#include <lgabench/host/system_calls.hpp>

namespace lgabench {

/// Processes that a process started and, if the process is a subreaper, its descendants whose own parent is gone.
std::vector<pid_t> children_of(pid_t parent);

/// What is started, and with what.
struct HostCommand {
  std::vector<std::string> words;            // an absolute path, and its arguments
  std::filesystem::path scratch;             // its directory, HOME and TMPDIR; there already
  std::vector<std::string> also_set;         // variables beside those of the allow-list, as NAME=value
  const Confinement* confinement = nullptr;  // lent; none: it may reach what we may
  long long memory_bytes = 0;  // of all its processes; shared memory, pipes and sockets included; 0: no limit
  bool trusted = false;        // it has all of our environment but names that speak of secrets
  bool offline = false;        // it may open no socket of the internet
  bool in_foreground = false;  // on our terminal, until whoever debugs it ends it
};

/// Descriptor on which a worker that is debugged reads what the person types; its standard input is the job.
constexpr int persons_input = 4;

/// What a process used since it began.
struct ProcessUse {
  double cpu_s = 0;          // of all its threads
  long long peak_bytes = 0;  // the most memory that it had in use (VmHWM)
};

/// A process in a session of its own with the socket as descriptor 3. What it and its children print goes to our
/// stdout, cut off at 16 MiB. It, and whatever it left behind, is gone when this is; in the foreground that is waited
/// for.
class HostProcess {
 public:
  /// @throws EngineError, InputError where no process can be started.
  explicit HostProcess(const HostCommand& command);
  ~HostProcess();
  HostProcess(const HostProcess&) = delete;
  HostProcess& operator=(const HostProcess&) = delete;

  /// Our end; to be taken once.
  Descriptor take_socket() { return std::move(socket_); }
  /// Returns when the socket `fd` has one of the poll() events, or after a moment; passes on what the process prints. A
  /// process over its limits is ended: @throws std::bad_alloc for memory, MethodGone for files in its directory,
  /// processes and threads.
  void wait(int fd, short events);
  /// Names of the system calls that it was refused so far.
  const std::vector<std::string>& refused_calls() const { return calls_.refused(); }
  /// Processes that it started, directly or not, and that are still there: "NUMBER NAME" each.
  std::vector<std::string> started() const;
  /// What the process itself used, not those that it started; 0 where it is gone.
  ProcessUse used() const;
  /// Call it when the connection has ended. `last_words`: what the process said of its end, or "". @throws MethodGone
  /// that says how the process ended, always.
  [[noreturn]] void explain(const std::string& last_words);

 private:
  void attend(int fd, short events, int milliseconds);
  void pass_on_output();
  void watch_use();
  void stop();

  long long memory_bytes_;
  bool in_foreground_;
  std::chrono::steady_clock::time_point look_again_{};
  pid_t pid_ = -1;
  bool reaped_ = false;
  Descriptor socket_, output_, scratch_;
  NotedCalls calls_;
  std::size_t started_ = 0;  // of them at the last look
  std::size_t printed_ = 0;
};

}  // namespace lgabench
