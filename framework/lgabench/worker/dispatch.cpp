#include <lgabench/worker/dispatch.hpp>

#include <algorithm>
#include <array>
#include <csignal>

#include <lgabench/core/exit_status.hpp>
#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/worker/verbs.hpp>

namespace lgabench::worker {
namespace {

constexpr std::array own_verbs{
    Verb{"cell", "Compute the cell described as JSON on stdin; progress on descriptor 3", cell},
    Verb{"check-job", "Check the plugin described as JSON on stdin", check_job},
    Verb{"ask", "Ask a server the questions described as JSON on stdin", ask},
    Verb{"act", "Act with a kept policy (a job on stdin)", act},
};

}  // namespace

const Verb* find_verb(std::string_view name) {
  const auto* const found =
      std::find_if(own_verbs.begin(), own_verbs.end(), [name](const Verb& verb) { return verb.name == name; });
  return found == own_verbs.end() ? nullptr : found;
}

int worker_program(int argc, char** argv) {
  open_standard_streams();
  flush_denormals();
  know_python_environments();
  ::signal(SIGXFSZ, SIG_IGN);  // a file over the limit (ulimit -f) is an error, not the end
  const Verb* const verb = argc == 2 ? find_verb(argv[1]) : nullptr;
  if (!verb) {
    to_stderr("lgabench-worker: expected one of these after it:\n");
    for (const Verb& one : own_verbs) to_stderr("  {:<12}{}\n", one.name, one.summary);
    return exit_status::usage;
  }
  try {
    verb->run();
    flush_stdout();
    return exit_status::ok;
  } catch (...) {
    return report_error("lgabench-worker");
  }
}

}  // namespace lgabench::worker
