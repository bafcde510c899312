// lgabench: everything that needs no engine. Verbs that do are handed to lgabench-worker, whole.
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/core/version.hpp>

namespace {

using namespace lgabench;

constexpr std::array<std::pair<const char*, const char*>, 3> worker_verbs{{
    {"select", "Ask which features matter for a command, and print the Selection"},
    {"demos", "Write the oracle's demonstrations of a scenario as robomimic HDF5"},
    {"render", "Draw a scene, its ids and its goal mask as a PNG"},
}};

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
    for (const auto& [verb, summary] : worker_verbs)
      if (std::string_view(argv[1]) == verb) return hand_to_worker(argv);

  int exit = cli::ok;
  CLI::App app("A benchmark of state abstraction in imitation learning", "lgabench");
  app.set_version_flag("--version", LGABENCH_VERSION);
  app.require_subcommand(1);
  app.footer("Example: lgabench run q1 --preset smoke");
  cli::add_list(app, exit);
  cli::add_info(app, exit);
  cli::add_run(app, exit);
  cli::add_merge(app, exit);
  cli::add_report(app, exit);
  cli::add_compare(app, exit);
  cli::add_verify(app, exit);
  cli::add_new_plugin(app, exit);
  cli::add_check_plugin(app, exit);
  for (const auto& [verb, summary] : worker_verbs) app.add_subcommand(verb, summary);
  return cli::dispatch(app, argc, argv, exit);
}
