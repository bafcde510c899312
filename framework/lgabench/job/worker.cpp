#include <lgabench/job/worker.hpp>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <lgabench/core/files.hpp>
#include <lgabench/core/process.hpp>

namespace lgabench {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// Standard output of the worker, given `input`. Returns what went wrong, or "".
std::string run_worker(const std::string& verb, const std::string& input, std::string& output) {
  const File in(std::tmpfile(), std::fclose), out(std::tmpfile(), std::fclose);
  if (!in || !out || std::fwrite(input.data(), 1, input.size(), in.get()) != input.size() || std::fflush(in.get()) != 0)
    return fmt::format("no temporary file could be written: {}", std::strerror(errno));
  std::rewind(in.get());

  const std::string program = (program_directory() / "lgabench-worker").string();
  const int status =
      wait_for(start_process({{program, verb},
                              environment_with({}),
                              {{::fileno(in.get()), STDIN_FILENO}, {::fileno(out.get()), STDOUT_FILENO}}}));
  if (WIFEXITED(status) && WEXITSTATUS(status) == not_started) return "lgabench-worker could not be started";
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return "lgabench-worker failed";

  std::rewind(out.get());
  char buffer[1 << 16];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, out.get())) > 0;) output.append(buffer, n);
  return "";
}

}  // namespace

WorkerAnswers ask_worker(const std::string& verb, const Json& requests) {
  WorkerAnswers answers;
  std::string text;
  answers.problem = run_worker(verb, canonical(requests), text);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    answers.lines.push_back(json_or_null(text.substr(begin, end - begin)));
    begin = std::min(end + 1, text.size());
  }
  return answers;
}

}  // namespace lgabench
