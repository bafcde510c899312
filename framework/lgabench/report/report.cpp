#include <lgabench/report/report.hpp>

#include <lgabench/core/error.hpp>
#include <lgabench/report/html.hpp>
#include <lgabench/report/tables.hpp>

namespace lgabench::report {
namespace {

RunResults read_cells(const fs::path& run) {
  RunResults results = read_run(run);
  if (results.cells.empty())
    throw InputError((run / "cells").string() + ": no cell of the run has been played yet: nothing to report");
  return results;
}

}  // namespace

void write_report(const fs::path& run) {
  const RunResults results = read_cells(run);
  const Summary summary = summarize(results);
  write_file(run / "summary.json", canonical(to_json(summary)) + "\n");
  write_file(run / "summary.csv", to_csv(summary));

  const std::vector<Claim> claims = test_claims(results);
  write_file(run / "claims.json", canonical(to_json(summary.suite, claims)) + "\n");

  const PaperValues paper = paper_values(summary.suite);
  std::vector<std::vector<Figure>> figures;
  for (const Table& table : summary.tables) figures.push_back(draw_figures(run, summary.suite, table, paper));
  write_file(run / "report.md", markdown(results, summary, claims, paper, figures));
  write_file(run / "report.html", html(results, summary, paper, draw_pictures(run, results)));
}

std::string table_text(const fs::path& run) {
  const RunResults results = read_cells(run);
  return plain_text(results, summarize(results));
}

}  // namespace lgabench::report
