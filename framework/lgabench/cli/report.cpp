// lgabench report: makes a run's tables, figures and page anew, and prints the tables.
#include <fmt/format.h>

#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/report/report.hpp>

namespace lgabench::cli {

void add_report(CLI::App& app, int& exit) {
  struct Options {
    std::string run, format = "text";
  };
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand(
      "report", "Make a run's tables, figures and report.html anew from its cells, and print the tables");
  verb->add_option("RUN", options->run, "The run's directory")->required();
  verb->add_option("--format", options->format, "What to print: text, md, json or csv")
      ->check(CLI::IsMember({"text", "md", "json", "csv"}))
      ->capture_default_str();
  verb->footer(
      "Writes RUN/report.html (one page to look at, with everything inside it), report.md, summary.json, summary.csv\n"
      "and figures/.\n"
      "Example: lgabench report runs/q1-smoke --format csv > table.csv\n"
      "         xdg-open runs/q1-smoke/report.html");
  verb->callback([options, &exit] {
    const fs::path run = options->run;
    report::write_report(run);
    if (options->format == "text")
      fmt::print("{}", report::table_text(run));
    else if (options->format == "md")
      fmt::print("{}", read_file(run / "report.md"));
    else
      fmt::print("{}", read_file(run / ("summary." + options->format)));
    fmt::print(stderr, "{}\n", (run / "report.html").string());
    exit = ok;
  });
}

}  // namespace lgabench::cli
