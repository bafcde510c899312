// lgabench merge: the shards of a run, or runs of several methods or seeds, put together.
#include <fmt/format.h>

#include <memory>

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
    bool json = false, partial = false;
  };
  auto options = std::make_shared<Options>();
  Verb verb(app, "merge", "Merge shards, or runs of different methods or seeds, and print the table");
  verb.option("OUT", options->out, "The directory to write", required);
  verb.option(
      "RUN", options->runs,
      "Shards of one run, or runs that differ only in methods, scenarios, layouts, engines, demonstrations, seeds "
      "or --selection-errors; they stay as they are",
      required);
  verb.option("--partial", options->partial, "Exit 0 even if parts of the run are missing");
  verb.option("--json", options->json, "Print summary.json instead of the table");
  verb->footer(
      "Example: lgabench merge runs/q1 runs/q1-1of2 runs/q1-2of2\n"
      "         lgabench merge runs/with_mine runs/q1 runs/q1_my_method\n"
      "Exit 3: a cell failed, is in none of the runs, or was left out because its files are damaged or come from "
      "another build.");
  verb->callback([options, &exit] {
    const MergeOutcome outcome = merge_runs(options->out, options->runs, shell_line(command_line()));
    const std::size_t bad = outcome.failed + outcome.left_out;
    to_stderr("{} cells finished, {} failed, {} left out, {} in none of the runs\n", outcome.finished, outcome.failed,
              outcome.left_out, outcome.missing);
    if (bad + outcome.missing > 0)
      to_stderr(
          "To compute the rest of shards, run the command of one with --out {} and without --shard. Resume other "
          "runs, and merge again.\n",
          options->out.string());
    if (outcome.finished + outcome.failed > 0) {  // last: it may throw
      print_report(options->out, options->json ? Printed::json : Printed::end);
      if (!options->json) print_page(options->out);
    }
    exit = bad > 0 || (outcome.missing > 0 && !options->partial) ? cells_failed : ok;
  });
}

}  // namespace lgabench::cli
