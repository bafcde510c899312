// lgabench report: makes a run's tables, figures and page anew, and prints the tables.
#include <fmt/format.h>

#include <algorithm>

#include <lgabench/cli/help.hpp>
#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/report/report.hpp>
#include <lgabench/report/writers.hpp>

namespace lgabench::cli {
namespace {

int verdict_of(const report::RunResults& results, const std::vector<report::Claim>& claims) {
  if (results.not_run > 0) to_stderr("{} cells of the run have not been played: not final\n", results.not_run);
  if (results.smoke) to_stderr("Smoke or limited run: not for the leaderboard.\n");
  const bool reversed =
      std::any_of(claims.begin(), claims.end(), [](const auto& c) { return c.verdict == report::Verdict::reversed; });
  return reversed ? regression : ok;
}

void print_section(const std::vector<report::Claim>& claims, const std::string& title) {
  to_stdout("{}\n\n{}", title, report::terminal(report::claims_section(claims, report::MethodStyles(), title)));
}

int print_claims(const fs::path& run, const report::Report& report, const std::string& format) {
  const auto& claims = report.claims;
  if (format == "text")
    print_section(claims, "The paper's claims");
  else if (format == "json")
    to_stdout("{}", read_file(run / "claims.json"));
  else
    throw InputError("--claims: expected --format text or json");
  return verdict_of(report.run, claims);
}

int print_difference(const report::RunResults& results, const std::vector<std::string>& rows,
                     const std::string& format) {
  const std::vector<report::Claim> claims = report::test_difference(results, rows.at(0), rows.at(1));
  if (format == "text")
    print_section(claims, "Two rows, paired");
  else if (format == "json")
    to_stdout("{}\n", report::to_json(results.suite, claims).dump(2));
  else
    throw InputError("--difference: expected --format text or json");
  return verdict_of(results, claims);
}

}  // namespace

void add_report(CLI::App& app, int& exit) {
  struct Options {
    std::string run, format = "text";
    bool claims = false;
    std::vector<std::string> difference;
  };
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand(
      "report", "Make a run's tables, figures and report.html anew from its cells, and print the tables");
  verb->add_option("RUN", options->run, "The run's directory")->required();
  verb->add_option("--format", options->format, "What to print: text, md, json or csv")
      ->check(one_of("format", {"text", "md", "json", "csv"}))
      ->capture_default_str();
  verb->add_flag("--claims", options->claims,
                 "Test the paper's claims instead of printing tables (text or json); exit 1 if one is reversed");
  verb->add_option("--difference", options->difference,
                   "Test row A against row B, paired, instead of printing tables (text or json); exit 1 if B is "
                   "above A beyond chance")
      ->delimiter(',')
      ->expected(2);
  arrange(*verb, "", {{"RUN", "RUN"}, {"--format", "text|md|json|csv"}, {"--difference", "A,B"}});
  verb->footer(
      "Writes RUN/report.html (one page to look at, with everything inside it), report.md, summary.json, summary.csv,\n"
      "episodes.csv, claims.json, each figure as SVG and PDF (figures/), each table as LaTeX and CSV (tables/).\n"
      "Example: lgabench report runs/q1-smoke --format csv > table.csv\n"
      "         xdg-open runs/q1-smoke/report.html\n"
      "The paper's claims: lgabench report runs/q2 --claims\n"
      "Two rows: lgabench report runs/q1 --difference lga,my_method");
  verb->callback([options, &exit] {
    const fs::path run = options->run;
    expect_run(run);
    const report::Report report = report::write_report(run);
    if (options->claims) {
      exit = print_claims(run, report, options->format);
      return;
    }
    if (!options->difference.empty()) {
      exit = print_difference(report.run, options->difference, options->format);
      return;
    }
    if (options->format == "text")
      print_tables(report);
    else if (options->format == "md")
      to_stdout("{}", read_file(run / "report.md"));
    else
      to_stdout("{}", read_file(run / ("summary." + options->format)));
    to_stderr("{}\n", (run / "report.html").string());
    exit = ok;
  });
}

}  // namespace lgabench::cli
