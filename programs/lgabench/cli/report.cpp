// lgabench report: makes a run's tables, figures and page anew, and prints the tables.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/shell.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/document/writers.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/report/report.hpp>

namespace lgabench::cli {
namespace {

int print_claims(const report::Report& report, const std::string& format) {
  const auto& claims = report.claims;
  if (format == "text")
    print_claims_section(claims, statistics::claims_title(claims));
  else if (format == "json")
    to_stdout("{}\n", canonical(statistics::to_json(report.summary.suite, claims)));
  else
    throw InputError("--claims: expected --format text or json");
  return verdict_of(report.run, claims);
}

// Each run's report, and a page over those that are runs.
int report_all(const std::vector<std::string>& directories, const std::string& index) {
  std::vector<report::Report> reports;
  for (const std::string& directory : directories) {
    if (!is_run(directory)) continue;
    reports.push_back(report::write_report(directory));
    to_stderr("{}\n", (fs::path(directory) / report_file::page).string());
  }
  if (reports.empty()) expect_run(directories.front());  // says which there are
  const fs::path first = reports.front().run.directory.lexically_normal(),
                 beside = first.has_filename() ? first.parent_path() : first.parent_path().parent_path();
  const fs::path file = index.empty() ? beside / "index.html" : fs::path(index);
  put(stdout, printable(document::terminal(report::write_index(reports, file), "")));
  to_stderr("{}\n", file.string());
  int exit = ok;
  for (const report::Report& report : reports) exit = std::max(exit, exit_of(report.run, ok));
  return exit;
}

int difference_as_in_0_4(const fs::path& run, const std::vector<std::string>& rows, const std::string& format) {
  if (format != "text" && format != "json") throw InputError("--difference: expected --format text or json");
  const bool json = format == "json";
  say_renamed("report --difference",
              shell_line({"lgabench", "compare", run.string(), "--difference", rows.at(0) + "," + rows.at(1)}) +
                  (json ? " --json" : ""));
  return print_difference(statistics::read_run(run), rows, json);
}

int pose_as_in_0_4(const fs::path& run, const std::vector<std::string>& within, const std::string& format) {
  if (format != "text" && format != "json" && format != "csv")
    throw InputError("--judge pose: expected --format text, json or csv");
  std::vector<std::string> words{"rescore", run.string(), "--judge",
                                 "pose",    "--format",   format == "text" ? "tables" : format};
  if (!within.empty()) words.insert(words.end(), {"--within", fmt::format("{}", fmt::join(within, ","))});
  say_renamed("report --judge pose", "lgabench " + shell_line(words));
  return hand_to_worker(words);
}

}  // namespace

void add_report(CLI::App& app, int& exit) {
  struct Options {
    std::vector<std::string> runs;
    std::string format = "text", index;
    bool claims = false;
    std::vector<std::string> difference;
    std::string judge = "physics";
    std::vector<std::string> within;
  };
  auto options = std::make_shared<Options>();
  Verb verb(app, "report", "Make a run's tables, figures and report.html anew from its cells, and print the tables");
  verb.option("RUN", options->runs,
              "The run's directory; for several, such as runs/*, report also writes a page that compares them",
              required);
  verb.option("--index FILE.html", options->index,
              "The page that compares several runs (default: index.html beside the first run)");
  verb.option("--format text|md|latex|json|csv", options->format, "What to print; latex is every table",
              one_of("format", {"text", "md", "latex", "json", "csv"}), with_default);
  auto* claims = verb.option("--claims", options->claims,
                             "Test the suite's own claims, or else the paper's, instead of printing "
                             "tables (text or json); exit 1 if one is reversed");
  // Until 0.6: `compare` and `rescore` have them.
  verb.option("--difference A,B", options->difference, "")->expected(2)->excludes(claims)->group("");
  verb.option("--judge physics|pose", options->judge, "", one_of("judge", {"physics", "pose"}))->group("");
  verb.option("--within BEGIN,END", options->within, "")->group("");
  verb->footer(
      "report writes RUN/report.html (one page that needs no other file), report.md, summary.json, summary.csv, "
      "episodes.csv, claims.json, each figure as SVG and PDF (figures/), each table as LaTeX and CSV (tables/).\n"
      "Example: lgabench report runs/q1-smoke --format csv > table.csv\n"
      "         xdg-open runs/q1-smoke/report.html\n"
      "All runs, and a page that compares them: lgabench report runs/*\n"
      "The paper's claims: lgabench report runs/q2 --claims");
  verb->callback([options, &exit] {
    const bool by_pose = options->judge == "pose";
    if (!by_pose && !options->within.empty()) throw InputError("--within: expected --judge pose");
    if (options->runs.size() > 1) {
      if (options->claims || !options->difference.empty() || options->format != "text" || by_pose)
        throw InputError("report: several runs have a page and a table; give one run for anything else");
      exit = report_all(options->runs, options->index);
      return;
    }
    if (!options->index.empty()) throw InputError("--index: expected several runs");
    const fs::path run = options->runs.front();
    expect_run(run);
    if (!options->difference.empty()) {
      exit = difference_as_in_0_4(run, options->difference, options->format);
      return;
    }
    if (by_pose) {
      exit = pose_as_in_0_4(run, options->within, options->format);
      return;
    }
    const report::Report report = report::write_report(run);
    if (options->claims) {
      exit = print_claims(report, options->format);
      return;
    }
    if (options->format == "text")
      print_tables(report);
    else if (options->format == "latex")
      for (const document::Grid* grid : report.document.grids())
        to_stdout("% {}\n{}\n", grid->caption, document::latex(*grid));
    else if (options->format == "md")
      to_stdout("{}", read_file(run / report_file::markdown));
    else
      to_stdout("{}", read_file(run / ("summary." + options->format)));
    to_stderr("{}\n", (run / report_file::page).string());
    exit = exit_of(report.run, ok);
  });
}

}  // namespace lgabench::cli
