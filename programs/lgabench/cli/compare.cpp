// lgabench compare: is run B worse than run A, or one row than another?
#include <fmt/format.h>

#include <algorithm>

#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/report/report.hpp>

namespace lgabench::cli {
namespace {

// A run all of whose cells can be read: a comparison of the others would say less than it seems to.
statistics::RunResults read_whole(const fs::path& directory) {
  expect_run(directory);
  statistics::RunResults run = statistics::read_run(directory);
  name_other_version(run);
  if (!run.unreadable.empty()) throw InputError(run.unreadable.front());
  const auto failed = std::count_if(run.cells.begin(), run.cells.end(), [](const auto& cell) { return cell.failed; });
  if (failed > 0 || run.not_run > 0)
    to_stderr("{}: of {} cells {} failed and {} have not been played: only the others are compared\n",
              directory.string(), run.record.cells.size(), failed, run.not_run);
  return run;
}

}  // namespace

void add_compare(CLI::App& app, int& exit) {
  struct Options {
    std::string a, b;
    std::vector<std::string> rows, difference;
    bool json = false, times = false;
  };
  auto options = std::make_shared<Options>();
  Verb verb(app, "compare",
            "Compare two runs scene by scene: success and seconds of each row; exit 1 if B is worse beyond chance");
  verb.option("A", options->a, "A run's directory", required);
  verb.option("B", options->b,
              "Another run's directory, with the same suite and number of episodes; with --rows you may leave "
              "it out, to compare two rows of A");
  auto* by_rows = verb.option("--rows ROW_A,ROW_B", options->rows,
                              "Compare a row of A with a row of B, whatever their methods and options")
                      ->expected(2);
  verb.option(
          "--difference ROW_A,ROW_B", options->difference,
          "Test a row of A against another one over scenarios, as claims are tested; exit 1 if ROW_B is above ROW_A "
          "beyond chance")
      ->expected(2)
      ->excludes(by_rows);
  verb.option("--times", options->times, "Print the seconds of each phase, not only of whole cells");
  verb.option("--json", options->json, "Print JSON instead of tables");
  verb->footer(
      "Example: lgabench compare runs/before runs/after\n         lgabench compare runs/paper runs/mine --rows "
      "lga,my_method\n         lgabench compare runs/q1 --difference lga,my_method\nThe verdict comes first: whether a "
      "row is worse beyond chance, or a cell of A fails in B or is "
      "missing there.\nExit 1: one of these holds; with --rows, missing cells do not count.\nRows are paired by method "
      "and options, not by name. Cells that played other scenes are listed, not compared.");
  verb->callback([options, &exit] {
    if (!options->difference.empty()) {
      if (!options->b.empty() || options->times) throw InputError("--difference: expected one run, without --times");
      expect_run(options->a);
      exit = print_difference(statistics::read_run(options->a), options->difference, options->json);
      return;
    }
    std::optional<statistics::RowPair> rows;
    if (!options->rows.empty()) rows = statistics::RowPair{options->rows[0], options->rows[1]};
    if (options->b.empty() && !rows) throw InputError("compare: expected A B, or A with --rows or --difference");
    const statistics::RunResults a = read_whole(options->a);
    const statistics::RunComparison comparison =
        statistics::compare_runs(a, options->b.empty() ? a : read_whole(options->b), rows);
    to_stdout("{}", options->json ? canonical(statistics::to_json(comparison)) + '\n'
                                  : report::comparison_text(comparison, options->times));
    exit = comparison.regressed() ? regression : ok;
  });
}

}  // namespace lgabench::cli
