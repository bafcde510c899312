// How this project starts a process: what is easily forgotten is done in one place.
#pragma once
#include <sys/types.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/files.hpp>

namespace lgabench {

/// What is started, and with what.
struct ProcessStart {
  std::vector<std::string> words;      // the program and its arguments; without "/" it is looked for on PATH
  std::vector<std::string> variables;  // NAME=value: its whole environment
  std::vector<std::pair<int, int>> descriptors{};  // ours, and its number there; the others of 0 to 2 stay
  fs::path directory{};                            // "": ours
  std::function<bool()> in_child{};                // just before the program; false ends the process with status 126
};

/// Our own environment, as NAME=value, but for what `set` names; `set` comes first.
std::vector<std::string> environment_with(const std::vector<std::string>& set);

/// The exit status of a program that is not there, or cannot be run.
constexpr int not_started = 127;

/// Starts a process that dies with the thread that started it and holds no other descriptor than those named and 0 to
/// 2. What cannot be run ends as not_started. `in_child` runs in a copy of this process: it takes no lock that
/// another thread may hold. @throws InputError where the system starts no process.
pid_t start_process(const ProcessStart& start);

/// Waits for its end. Returns its status, as waitpid() does.
int wait_for(pid_t pid);

}  // namespace lgabench
