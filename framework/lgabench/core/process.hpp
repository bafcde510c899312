// Starts processes: what is easily forgotten is done here, in one place.
#pragma once
#include <sys/types.h>

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <lgabench/core/descriptor.hpp>
#include <lgabench/core/files.hpp>

namespace lgabench {

/// A program to start, and what it is started with.
struct ProcessStart {
  std::vector<std::string> words;      // the program and its arguments; without "/" it is looked for on PATH
  std::vector<std::string> variables;  // NAME=value: its whole environment
  std::vector<std::pair<int, int>> descriptors{};  // ours, and its number there; the others of 0 to 2 stay
  fs::path directory{};                            // "": ours
  std::function<bool()> in_child{};                // just before the program; false: it is not started, for errno
};

/// This process's environment, as NAME=value, with the variables of `set` replaced; these come first.
std::vector<std::string> environment_with(const std::vector<std::string>& set);

/// Starts a process that dies with the thread that started it and holds no descriptors but those named and 0 to 2.
/// Returns once its program runs, or after two seconds; one that fails later ends with status 127. `in_child` runs in a
/// copy of this process: it must take no lock that another thread may hold. @throws Refused where the system starts no
/// process, or the program cannot be run.
pid_t start_process(const ProcessStart& start);

/// Waits for its end. Returns its status, as waitpid() does.
int wait_for(pid_t pid);

/// A file that lies on no disk, with these bytes, read from its beginning. @throws Refused
Descriptor file_in_memory(std::string_view bytes = "");
/// All that such a file holds, wherever it is read. @throws Refused
std::string bytes_of(const Descriptor& file);

}  // namespace lgabench
