// lgabench: everything that needs no engine. Verbs that do are handed to lgabench-worker, whole.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include <lgabench/cli/commands.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/core/version.hpp>

#include "lgabench_commit.hpp"  // written by cmake/commit.cmake

namespace {

using namespace lgabench;

int hand_to_worker(char** argv) {
  const fs::path worker = program_directory() / "lgabench-worker";
  ::execv(worker.c_str(), argv);
  to_stderr("lgabench: {}: cannot be started: {}\n", worker.string(), std::strerror(errno));
  return cli::usage;
}

}  // namespace

int main(int argc, char** argv) {
  lgabench::open_standard_streams();
  if (argc > 1)
    for (const auto& [verb, summary] : cli::worker_verbs)
      if (std::string_view(argv[1]) == verb) return hand_to_worker(argv);

  int exit = cli::ok;
  CLI::App app(cli::about, "lgabench");
  app.set_version_flag("--version", "lgabench " LGABENCH_VERSION " (commit " LGABENCH_COMMIT ", " LGABENCH_BUILD ")",
                       "Print version, commit, build type and compiler");
  cli::add_commands(app, exit);
  for (const auto& [verb, summary] : cli::worker_verbs) app.add_subcommand(verb, summary);
  cli::arrange_commands(app);
  return cli::dispatch(app, argc, argv, exit);
}
