// lgabench_pages man|bash|zsh|fish: writes one of them on stdout, at build time.
#include <lgabench/cli/commands.hpp>
#include <lgabench/cli/pages.hpp>
#include <lgabench/core/terminal.hpp>

int main(int argc, char** argv) {
  using namespace lgabench;
  int exit = cli::ok;
  CLI::App app(cli::about, "lgabench");
  app.set_version_flag("--version", "", "Print version, commit, build type and compiler");
  cli::add_commands(app, exit);
  cli::add_select(app, exit);
  cli::add_demos(app, exit);
  cli::add_render(app, exit);
  cli::add_replay(app, exit);
  cli::add_rescore(app, exit);
  cli::add_check_scenario(app, exit);
  cli::add_bench(app, exit);
  cli::arrange_commands(app);
  const std::string what = argc == 2 ? argv[1] : "";
  if (what != "man" && what != "bash" && what != "zsh" && what != "fish") return cli::usage;
  to_stdout("{}", what == "man"    ? cli::man_page(app)
                  : what == "bash" ? cli::bash_completion(app)
                  : what == "zsh"  ? cli::zsh_completion(app)
                                   : cli::fish_completion(app));
  flush_stdout();
  return cli::ok;
}
