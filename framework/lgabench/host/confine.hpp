// What a method's process may reach: files by Landlock, system calls by seccomp (docs/trust.md).
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <lgabench/core/descriptor.hpp>

namespace lgabench {

struct Reach {
  std::vector<std::filesystem::path> reads;   // files, and directories with all below them
  std::vector<std::filesystem::path> writes;  // likewise, to be read and written
  std::vector<std::filesystem::path> hidden;  // neither, though they lie below one of `reads`
  bool network = false;  // sockets of IP, and what looking up a name and checking a certificate read
  std::vector<std::filesystem::path> unread{};  // as `hidden`, but that they are there, and their names, may be seen
  // Directories as `reads`, but names in them that begin with a dot are as `unread`: keys and settings lie in a home.
  std::vector<std::filesystem::path> folders{};
};

/// Limits that are prepared before a process is forked, and applied in it. A part that the kernel does not support is
/// left out.
class Confinement {
 public:
  /// Paths that are not there are passed over. @throws EngineError where the kernel refuses a rule.
  explicit Confinement(const Reach& reach);
  /// Call it in the child, before exec. From then on the child and all that it starts see only what `reach` says,
  /// signal and trace no other process, and without `network` connect to nobody; NotedCalls is told on the socket, if
  /// there is one. False where the kernel refused.
  bool apply(int socket = -1) const;

 private:
  Descriptor rules_;  // of Landlock, or none
  bool network_;
};

/// "Landlock 7, seccomp", or what of it this kernel lacks: "Landlock 3 (without: TCP, signals), seccomp".
std::string confinement_text();
/// Version of the kernel's Landlock; 0 without.
int landlock_version();

}  // namespace lgabench
