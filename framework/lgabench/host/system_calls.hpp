// Which system calls a method's process may make (docs/trust.md): a list of those that are allowed, and of their
// arguments.
#pragma once
#include <set>
#include <string>
#include <vector>

#include <lgabench/core/descriptor.hpp>

namespace lgabench {

bool has_seccomp();

/// Call it in the process itself, before exec. From then on the process and all that it starts can make the calls of
/// the list alone. A call newer than the list gets ENOSYS, so that a C library falls back; any other gets EPERM.
/// `network`: IP sockets too. Sends a byte on `socket`, unless that is -1, with a descriptor for NotedCalls where the
/// kernel has one. False
/// where it refused.
bool allow_system_calls(bool network, int socket);

/// Likewise, in a process that is not confined otherwise: it can open no socket of the internet, nor can what it
/// starts.
bool refuse_internet();

/// Calls that wait for whoever started the process: those that are refused, and those that start a process or a
/// thread, which it lets go on.
class NotedCalls {
 public:
  NotedCalls() = default;
  /// Waits for the byte of allow_system_calls(), or the other end's closing; says in the log where nothing can be
  /// named.
  explicit NotedCalls(int socket);

  /// To be watched for POLLIN; -1: none.
  int descriptor() const { return notifier_.fd; }
  /// Answers the call that waits, after poll() said `events`; until then it waits. A refused call's name is printed
  /// once, 64 at most.
  void take(short events);
  const std::vector<std::string>& refused() const { return names_; }
  /// Processes and threads so far; 0 where the kernel has no descriptor.
  std::size_t started() const { return started_; }

 private:
  Descriptor notifier_;
  std::size_t started_ = 0;
  std::vector<std::string> names_;
  std::set<int> seen_;
};

}  // namespace lgabench
