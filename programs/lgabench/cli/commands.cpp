#include <lgabench/cli/commands.hpp>

#include <lgabench/cli/help.hpp>

namespace lgabench::cli {

const char* const reference =
    "Environment\n"
    "  LGABENCH_CACHE            the folder of kept demonstrations (default: ~/.cache/lgabench)\n"
    "  LGABENCH_PLUGIN_PATH      directories of more plugins, separated by colons\n"
    "  LGABENCH_SCENARIO_PATH    directories of more scenarios, separated by colons\n"
    "  LGABENCH_DATA             scenarios, suites and answers to use instead of the installed ones\n"
    "  LGABENCH_ENCODER          the folder of the sentence encoder's weights\n"
    "  LGABENCH_PYTHON           the interpreter for plugins in Python\n"
    "  LGABENCH_NO_LOCKS         1: to work on file systems without locks, where nothing else writes\n"
    "  OPENAI_BASE_URL, OPENAI_API_KEY\n"
    "                            the server that `--answers openai` asks\n"
    "  NO_COLOR                  if set, lgabench prints without colour\n"
    "\n"
    "Exit status\n"
    "  0    all went well\n"
    "  1    `compare`: B is worse; `verify`: the results differ; `compare --difference`, `report`: a claim "
    "is reversed; `leaderboard`: refused, different or a problem; `check-plugin`, `check-scenario`: a "
    "problem; `attribute`: a row was left out; `encoder`: not installed\n"
    "  2    an error in the command line, a file or a directory; `leaderboard`: an entry was not played\n"
    "  3    `run`: a cell failed; `merge`, `status`, `rescore`: a cell failed or is missing; `rescore`: "
    "episodes were left out; `report`: no cell finished; `select`, `answers`: a question has no "
    "answer; `encoder`: the download failed; every command: any other error, such as a server "
    "that is not there or too little memory\n"
    "  4    a plugin is missing or was refused\n"
    "  5    `verify`: bytes differ and the record names another build, processor or data; outcomes "
    "differ no more than chance allows\n"
    "  130  interrupted; what was finished is kept";

namespace {

constexpr const char* examples =
    "Examples\n"
    "  lgabench run q1 --preset smoke\n"
    "  lgabench run --help\n"
    "\n"
    "Documentation: docs/README.md in the sources, share/doc/lgabench/docs in an installation";

// lgabench_program() answers it with what CLI11 knows: --help and --help-all.
void add_help(CLI::App& app) {
  static std::string topic;
  Verb verb(app, "help", "Show the first commands, all commands, or how one of them is used");
  verb.option("topic TOPIC", topic, "all, or a command");
  verb->footer("Example: lgabench help all\n         lgabench help run");
}

}  // namespace

void add_commands(CLI::App& app, int& exit) {
  app.formatter(help_formatter({first_commands.begin(), first_commands.end()}, reference));
  app.footer(examples);
  app.require_subcommand(0, 1);  // a word behind a command is its own, also where it reads like another command
  add_list(app, exit);
  add_info(app, exit);
  add_run(app, exit);
  add_report(app, exit);
  add_open(app, exit);
  add_compare(app, exit);
  add_verify(app, exit);
  add_attribute(app, exit);
  add_merge(app, exit);
  add_cluster(app, exit);
  add_status(app, exit);
  add_leaderboard(app, exit);
  add_answers(app, exit);
  add_new_plugin(app, exit);
  add_check_plugin(app, exit);
  add_new_scenario(app, exit);
  add_new_suite(app, exit);
  add_drawn_commands(app, exit);
  add_study(app, exit);
  add_encoder(app, exit);
  add_cache(app, exit);
  add_help(app);
}

void arrange_commands(CLI::App& app) {
  // Not before: commands that are added later would have it too.
  app.set_help_all_flag("--help-all", "Print every command, environment variable and exit status, and exit");
  const std::pair<const char*, std::vector<const char*>> titles[] = {
      {"To look around", {"list", "help", "info", "select", "answers", "render", "demos", "replay"}},
      {"To run and to compare", {"run", "open", "report", "rescore", "compare", "verify", "attribute"}},
      {"To run on many machines", {"cluster", "status", "merge"}},
      {"To publish", {"leaderboard"}},
      {"To add a method, an engine or a scenario",
       {"new-plugin", "check-plugin", "bench", "new-scenario", "new-suite", "check-scenario", "draw-commands"}},
      {"To run a user study", {"study"}},
      {"To look after an installation", {"encoder", "cache"}}};
  for (const auto& [title, names] : titles)
    for (const char* name : names)
      for (CLI::App* verb : app.get_subcommands([&](CLI::App* one) { return one->get_name() == name; }))
        verb->group(title);
}

}  // namespace lgabench::cli
