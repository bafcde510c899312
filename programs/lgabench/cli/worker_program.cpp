#include <lgabench/cli/programs.hpp>

#include <algorithm>
#include <array>
#include <string>

#include <lgabench/cli/help.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/core/version.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/worker/dispatch.hpp>

namespace lgabench::cli {

int worker_with_programs(int argc, char** argv) {
  if (argc > 1 && worker::find_verb(argv[1])) return worker::worker_program(argc, argv);
  know_python_environments();
  constexpr std::array plays{"bench", "check-scenario", "demos", "render", "replay"};
  if (argc > 1 && contains(plays, std::string(argv[1]))) let_environments_start();
  open_standard_streams();
  flush_denormals();
  int exit = ok;
  // A person called `lgabench`, which became this process.
  const std::string name = argc > 0 ? fs::path(argv[0]).filename().string() : "lgabench-worker";
  CLI::App app("Runs one cell, or a verb that needs an engine", name);
  app.set_version_flag("--version", LGABENCH_VERSION);
  app.formatter(help_formatter());
  add_select(app, exit);
  add_demos(app, exit);
  add_render(app, exit);
  add_pictures(app, exit);
  add_strips(app, exit);
  add_check_scenario(app, exit);
  add_bench(app, exit);
  add_replay(app, exit);
  add_rescore(app, exit);
  return dispatch(app, {argv + std::min(argc, 1), argv + argc}, exit);
}

}  // namespace lgabench::cli
