// Which system calls a method's process may make (docs/trust.md): a list of those that are allowed, and of their
// arguments.
#pragma once
#include <set>
#include <string>
#include <vector>

#include <lgabench/core/descriptor.hpp>

namespace lgabench {

bool has_seccomp();

/// In the process itself, before exec. From then on it and all that it starts make the calls of the list alone. What is
/// newer than the list answers ENOSYS, so that a C library falls back; anything else EPERM. `network`: IP sockets too.
/// Sends a byte on `socket`, unless that is -1, with a descriptor for RefusedCalls where the kernel has one. False
/// where it refused.
bool allow_system_calls(bool network, int socket);

/// Names of the calls that are refused, as whoever started the process learns them.
class RefusedCalls {
 public:
  RefusedCalls() = default;
  /// Waits for the byte of allow_system_calls(), or the other end's closing; says in the log where nothing can be
  /// named.
  explicit RefusedCalls(int socket);

  /// To be watched for POLLIN; -1: none.
  int descriptor() const { return notifier_.fd; }
  /// Refuses the call that waits, after poll() said `events`. A name is printed once, 64 at most.
  void take(short events);
  const std::vector<std::string>& names() const { return names_; }

 private:
  Descriptor notifier_;
  std::vector<std::string> names_;
  std::set<int> seen_;
};

}  // namespace lgabench
