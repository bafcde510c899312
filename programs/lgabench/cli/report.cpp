// lgabench report: makes a run's tables, figures and page anew, and prints the tables.
#include <fmt/format.h>

#include <algorithm>

#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/document/writers.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/report/report.hpp>

namespace lgabench::cli {
namespace {

// Names the cells that could not be read; their run is then an error, though its report is there. So is one without a
// number: no cell finished.
int exit_of(const statistics::RunResults& results, int otherwise) {
  name_other_version(results);
  for (const std::string& why : results.unreadable) to_stderr("left out: {}\n", why);
  if (results.not_run > 0) to_stderr("{} cells of the run have not been played: not final\n", results.not_run);
  if (!results.unreadable.empty()) return usage;
  const bool none_finished =
      std::all_of(results.cells.begin(), results.cells.end(), [](const auto& cell) { return cell.failed; });
  if (none_finished)
    to_stderr("{}: all its {} cells failed: nothing was measured\n", results.directory.string(), results.cells.size());
  return none_finished ? cells_failed : otherwise;
}

int verdict_of(const statistics::RunResults& results, const std::vector<statistics::Claim>& claims) {
  if (results.record.smoke) to_stderr("Smoke or limited run: not for the leaderboard.\n");
  const bool reversed = std::any_of(claims.begin(), claims.end(),
                                    [](const auto& c) { return c.verdict == statistics::Verdict::reversed; });
  return exit_of(results, reversed ? regression : ok);
}

void print_section(const std::vector<statistics::Claim>& claims, const std::string& title) {
  to_stdout("{}\n\n{}", title, document::terminal(report::claims_section(claims, statistics::MethodStyles(), title)));
}

int print_claims(const report::Report& report, const std::string& format) {
  const auto& claims = report.claims;
  if (format == "text")
    print_section(claims, statistics::claims_title(claims));
  else if (format == "json")
    to_stdout("{}\n", canonical(statistics::to_json(report.summary.suite, claims)));
  else
    throw InputError("--claims: expected --format text or json");
  return verdict_of(report.run, claims);
}

int print_difference(const statistics::RunResults& results, const std::vector<std::string>& rows,
                     const std::string& format) {
  const std::vector<statistics::Claim> claims = statistics::test_difference(results, rows.at(0), rows.at(1));
  if (format == "text")
    print_section(claims, "Two rows, paired");
  else if (format == "json")
    to_stdout("{}\n", statistics::to_json(results.suite, claims).dump(2));
  else
    throw InputError("--difference: expected --format text or json");
  return verdict_of(results, claims);
}

// By pose nothing is written into the run: physics judges what its files say.
int print_by_pose(const report::Report& report, const statistics::PoseTolerance& tolerance, const std::string& format) {
  if (format == "json") {
    to_stdout("{}\n", canonical(statistics::to_json(report.summary)));
  } else if (format == "csv") {
    to_stdout("{}", report::to_csv(report.summary));
  } else if (format == "text") {
    to_stdout(
        "Success by pose: the action begins within {:g} m and ends within {:g} m of the oracle's, and turns within "
        "{:g}° "
        "of it\nwhere the task asks for a turn, whatever physics made of it.\n\n",
        tolerance.begin_m, tolerance.end_m, tolerance.turn_deg);
    print_tables(report);
  } else {
    throw InputError("--judge pose: expected --format text, json or csv");
  }
  return exit_of(report.run, ok);
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

}  // namespace

void add_report(CLI::App& app, int& exit) {
  struct Options {
    std::vector<std::string> runs;
    std::string format = "text", index;
    bool claims = false;
    std::vector<std::string> difference;
    std::string judge = "physics";
    statistics::PoseTolerance tolerance;
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
  verb.option("--difference A,B", options->difference,
              "Test row A against row B, paired, instead of printing tables (text or json); exit 1 if B is "
              "above A beyond chance")
      ->expected(2)
      ->excludes(claims);
  verb.option("--judge physics|pose", options->judge,
              "How to judge episodes. physics: as they were played; pose: an action is a success if it is the oracle's "
              "up to --within; pose prints and writes no files",
              one_of("judge", {"physics", "pose"}), with_default);
  const std::function<void(const std::vector<double>&)> tolerate = [options](const std::vector<double>& metres) {
    options->tolerance.begin_m = metres.at(0);
    options->tolerance.end_m = metres.at(1);
  };
  auto* within_m = verb.option("--within BEGIN,END", tolerate,
                               "With --judge pose: how many metres apart the two actions may begin and end (default: "
                               "0.07,0.10)",
                               within(0, 10))
                       ->expected(2);
  verb->footer(
      "report writes RUN/report.html (one page that needs no other file), report.md, summary.json, summary.csv, "
      "episodes.csv, claims.json, each figure as SVG and PDF (figures/), each table as LaTeX and CSV (tables/).\n"
      "Example: lgabench report runs/q1-smoke --format csv > table.csv\n"
      "         xdg-open runs/q1-smoke/report.html\n"
      "All runs, and a page that compares them: lgabench report runs/*\n"
      "The paper's claims: lgabench report runs/q2 --claims\n"
      "Two rows: lgabench report runs/q1 --difference lga,my_method\n"
      "Success within 10 cm: lgabench report runs/q1 --judge pose --within 0.10,0.10");
  verb->callback([options, within_m, &exit] {
    const bool by_pose = options->judge == "pose";
    if (!by_pose && within_m->count() > 0) throw InputError("--within: expected --judge pose");
    if (options->runs.size() > 1) {
      if (options->claims || !options->difference.empty() || options->format != "text" || by_pose)
        throw InputError("report: several runs have a page and a table; give one run for anything else");
      exit = report_all(options->runs, options->index);
      return;
    }
    if (!options->index.empty()) throw InputError("--index: expected several runs");
    const fs::path run = options->runs.front();
    expect_run(run);
    const report::Report report = by_pose ? report::report_by_pose(run, options->tolerance) : report::write_report(run);
    if (options->claims) {
      exit = print_claims(report, options->format);
      return;
    }
    if (!options->difference.empty()) {
      exit = print_difference(report.run, options->difference, options->format);
      return;
    }
    if (by_pose) {
      exit = print_by_pose(report, options->tolerance, options->format);
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
