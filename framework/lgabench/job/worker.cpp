#include <lgabench/job/worker.hpp>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include <lgabench/core/files.hpp>
#include <lgabench/core/process.hpp>
#include <lgabench/core/refused.hpp>

namespace lgabench {
namespace {

// Standard output of the worker, given `input`. Returns what went wrong, or "".
std::string run_worker(const std::string& verb, const std::string& input, std::string& output) {
  const Descriptor in = file_in_memory(input), out = file_in_memory();
  const std::string program = (program_directory() / "lgabench-worker").string();
  const int status = wait_for(
      start_process({{program, verb}, environment_with({}), {{in.fd, STDIN_FILENO}, {out.fd, STDOUT_FILENO}}}));
  if (WIFSIGNALED(status))
    return fmt::format("lgabench-worker was ended by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0) return "lgabench-worker failed";
  output = bytes_of(out);
  return "";
}

}  // namespace

WorkerAnswers ask_worker(const std::string& verb, const Json& requests) {
  WorkerAnswers answers;
  std::string text;
  try {
    answers.problem = run_worker(verb, canonical(requests), text);
  } catch (const Refused& e) {  // without the program's path: reports, which people send on, have this text
    answers.problem = fmt::format("lgabench-worker could not be started: {}", std::strerror(e.reason));
  }
  std::size_t begin = 0;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    answers.lines.push_back(json_or_null(text.substr(begin, end - begin)));
    begin = std::min(end + 1, text.size());
  }
  return answers;
}

}  // namespace lgabench
