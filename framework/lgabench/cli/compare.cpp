// lgabench compare: is run B worse than run A?
#include <fmt/format.h>

#include <lgabench/cli/help.hpp>
#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/report/compare.hpp>

namespace lgabench::cli {

void add_compare(CLI::App& app, int& exit) {
  struct Options {
    std::string a, b;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand(
      "compare",
      "Compare two runs scene by scene: success and seconds of each row; exit 1 if B is worse beyond chance");
  verb->add_option("A", options->a, "A run's directory")->required();
  verb->add_option("B", options->b, "Another's, of the same suite and number of episodes")->required();
  verb->add_flag("--json", options->json, "Print JSON instead of tables");
  arrange(*verb, "", {{"A", "A"}, {"B", "B"}});
  verb->footer(
      "Example: lgabench compare runs/before runs/after\n"
      "Rows are paired by method and options, whatever they are named, also with those of a run of 0.1. Cells that "
      "played other scenes are named and not compared.");
  verb->callback([options, &exit] {
    expect_run(options->a);
    expect_run(options->b);
    const report::RunComparison comparison =
        report::compare_runs(report::read_run(options->a), report::read_run(options->b));
    to_stdout("{}",
              options->json ? canonical(report::to_json(comparison)) + '\n' : report::comparison_text(comparison));
    exit = comparison.regressed() ? regression : ok;
  });
}

}  // namespace lgabench::cli
