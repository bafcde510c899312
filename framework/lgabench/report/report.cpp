#include <lgabench/report/report.hpp>

#include <future>

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

Report write_report(const fs::path& run) {
  Report report;
  report.run = read_cells(run);
  report.summary = summarize(report.run);
  report.claims = test_claims(report.run);
  report.agreements = engine_agreement(report.run);
  const RunResults& results = report.run;
  const Summary& summary = report.summary;
  Json values = to_json(summary);
  if (!report.agreements.empty()) values["engine_agreement"] = to_json(report.agreements);
  write_file(run / "summary.json", canonical(values) + "\n");
  write_file(run / "summary.csv", to_csv(summary));
  write_file(run / "claims.json", canonical(to_json(summary.suite, report.claims)) + "\n");

  // Two programs draw at the same time: gnuplot the figures, lgabench-worker the scenes.
  std::future<Pictures> pictures =
      std::async(std::launch::async, [&] { return draw_pictures(run, results, report.agreements); });
  const PaperValues paper = paper_values(summary.suite);
  std::vector<std::vector<Figure>> figures;
  for (const Table& table : summary.tables) figures.push_back(draw_figures(run, summary.suite, table, paper));
  write_file(run / "report.md", markdown(results, summary, report.claims, report.agreements, paper, figures));
  write_file(run / "report.html", html(results, summary, report.claims, report.agreements, paper, pictures.get()));
  return report;
}

}  // namespace lgabench::report
