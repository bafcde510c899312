#include <lgabench/cli/programs.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include <lgabench/cli/commands.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench::cli {
namespace {

int hand_to_worker(char** argv) {
  const fs::path worker = program_directory() / "lgabench-worker";
  ::execv(worker.c_str(), argv);
  to_stderr("lgabench: {}: cannot be started: {}\n", worker.string(), std::strerror(errno));
  return usage;
}

}  // namespace

int lgabench_program(int argc, char** argv, const char* version) {
  open_standard_streams();
  if (argc > 1)
    for (const auto& [verb, summary] : worker_verbs)
      if (std::string_view(argv[1]) == verb) return hand_to_worker(argv);

  int exit = ok;
  CLI::App app(about, "lgabench");
  app.set_version_flag("--version", version, "Print version, commit, build type and compiler");
  add_commands(app, exit);
  for (const auto& [verb, summary] : worker_verbs) app.add_subcommand(verb, summary);
  arrange_commands(app);
  return dispatch(app, argc, argv, exit);
}

}  // namespace lgabench::cli
