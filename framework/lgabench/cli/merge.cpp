// lgabench merge: the shards of a run, or runs of several methods or seeds, put together.
#include <fmt/format.h>

#include <memory>

#include <lgabench/cli/help.hpp>
#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/shell.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/merge.hpp>

namespace lgabench::cli {

void add_merge(CLI::App& app, int& exit) {
  struct Options {
    fs::path out;
    std::vector<fs::path> runs;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      app.add_subcommand("merge", "Merge shards, or runs of different methods or seeds, and print the table");
  verb->add_option("OUT", options->out, "The directory to write")->required();
  verb->add_option(
          "RUN", options->runs,
          "Shards of one run, or runs that differ only in methods, scenarios, layouts, engines, demonstrations, seeds "
          "or --selection-errors; they stay as they are")
      ->required();
  verb->add_flag("--json", options->json, "Print summary.json instead of the table");
  arrange(*verb, "", {{"OUT", "OUT"}, {"RUN", "RUN"}});
  verb->footer(
      "Example: lgabench merge runs/q1 runs/q1-1of2 runs/q1-2of2\n"
      "         lgabench merge runs/with_mine runs/q1 runs/q1_my_method");
  verb->callback([options, &exit] {
    const MergeOutcome outcome = merge_runs(options->out, options->runs, shell_line(command_line()));
    to_stderr("{} cells finished, {} failed, {} in none of the runs\n", outcome.finished, outcome.failed,
              outcome.missing);
    if (outcome.failed + outcome.missing > 0)
      to_stderr(
          "Shards: the command of one of them, with --out {} and without --shard, computes the rest. Other runs: "
          "resume each, and merge again.\n",
          options->out.string());
    if (outcome.finished + outcome.failed > 0) print_report(options->out, options->json);  // last: it may throw
    exit = outcome.failed ? cells_failed : ok;
  });
}

}  // namespace lgabench::cli
