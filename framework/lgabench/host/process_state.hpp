// What a process holds, for `lgabench check-plugin`: asked of the process that runs the plugin.
#pragma once
#include <string>
#include <vector>

namespace lgabench {

/// Threads by number, open descriptors by what they lead to, bytes on the heap.
struct ProcessState {
  std::vector<std::string> threads, descriptors;  // sorted
  long long heap_bytes = 0;
  bool flushed = true;  // subnormal numbers, after every call so far
  bool rounds = true;   // to nearest, likewise

  /// State of this process; `flushed` and `rounds` are left to whoever made the calls.
  static ProcessState now();
  /// This state without the threads and descriptors of `before`.
  ProcessState beyond(const ProcessState& before) const;
};

/// Fills what the heap gives out with `byte` and, where it is not 0, moves what comes: deciding by an address and
/// reading what was never set show.
void perturb_heap(int byte);

}  // namespace lgabench
