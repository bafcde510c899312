// lgabench merge: the shards of a run put together.
#include <fmt/format.h>

#include <memory>

#include <lgabench/cli/help.hpp>
#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/verbs.hpp>
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
  CLI::App* verb = app.add_subcommand("merge", "Put the shards of a run together, and print its table");
  verb->add_option("OUT", options->out, "The directory to write")->required();
  verb->add_option("RUN", options->runs, "Directories of the same run; they stay as they are")->required();
  verb->add_flag("--json", options->json, "Print summary.json instead of the table");
  arrange(*verb, "", {{"OUT", "OUT"}, {"RUN", "RUN"}});
  verb->footer("Example: lgabench merge runs/q1 runs/q1-1of2 runs/q1-2of2");
  verb->callback([options, &exit] {
    const MergeOutcome outcome = merge_runs(options->out, options->runs, joined(command_line()));
    if (outcome.finished + outcome.failed > 0) print_report(options->out, options->json);
    to_stderr("{} cells finished, {} failed, {} in none of the runs\n", outcome.finished, outcome.failed,
              outcome.missing);
    if (outcome.failed + outcome.missing > 0)
      to_stderr("The command of one of the runs, with --out {} and without --shard, computes the rest.\n",
                options->out.string());
    exit = outcome.failed ? cells_failed : ok;
  });
}

}  // namespace lgabench::cli
