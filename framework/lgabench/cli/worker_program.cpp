// lgabench-worker: the process that loads plugins and engines. `lgabench` starts it; a person rarely does.
#include <lgabench/cli/help.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/core/version.hpp>

int main(int argc, char** argv) {
  lgabench::open_standard_streams();
  using namespace lgabench;
  flush_denormals();
  int exit = cli::ok;
  // A person called `lgabench`, which became this process.
  const std::string name = argc > 0 ? lgabench::fs::path(argv[0]).filename().string() : "lgabench-worker";
  CLI::App app("Runs one cell, or a verb that needs an engine", name);
  app.set_version_flag("--version", LGABENCH_VERSION);
  app.formatter(cli::help_formatter());
  cli::add_cell(app, exit);
  cli::add_check_job(app, exit);
  cli::add_ask(app, exit);
  cli::add_select(app, exit);
  cli::add_demos(app, exit);
  cli::add_render(app, exit);
  cli::add_pictures(app, exit);
  cli::add_strips(app, exit);
  cli::add_oracle(app, exit);
  cli::add_check_scenario(app, exit);
  cli::add_replay(app, exit);
  cli::add_rescore(app, exit);
  cli::add_act(app, exit);
  return cli::dispatch(app, argc, argv, exit);
}
