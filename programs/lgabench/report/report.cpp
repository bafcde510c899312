#include <lgabench/report/report.hpp>

#include <chrono>
#include <future>

#include <lgabench/core/error.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/document/writers.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/report/index.hpp>

namespace lgabench::report {
namespace {

void expect_cells(const RunResults& run) {
  if (run.cells.empty())
    throw InputError(run.unreadable.empty() ? (run.directory / "cells").string() +
                                                  ": no cell of the run has been played yet: nothing to report"
                                            : run.unreadable.front());
}

}  // namespace

Report write_report(const fs::path& run) {
  Report report;
  report.run = read_run(run);
  expect_cells(report.run);
  report.agreements = engine_agreement(report.run);
  auto drawing =                                              // by another process
      std::async(std::launch::async | std::launch::deferred,  // here, where no thread can be started
                 [&] { return draw_pictures(run, report.run, report.agreements); });
  report.summary = summarize(report.run);
  report.claims = test_claims(report.run);
  const Summary& summary = report.summary;
  Json values = to_json(summary);
  if (!report.agreements.empty()) values["engine_agreement"] = to_json(report.agreements);
  write_file(run / report_file::summary, canonical(values) + "\n");
  write_file(run / report_file::summary_table, to_csv(summary));
  write_file(run / report_file::episodes, episodes_csv(report.run));
  write_file(run / report_file::claims, canonical(to_json(summary.suite, report.claims)) + "\n");

  const PaperValues paper = paper_values(summary.suite);
  if (drawing.wait_for(std::chrono::seconds(5)) == std::future_status::timeout)
    to_stderr("{}: drawing episodes for its report\n", run.string());
  const Pictures pictures = drawing.get();
  const Material material{report.run, summary, report.claims, report.agreements, paper, pictures};
  report.document = report_document(material);
  report.brief = brief(material);
  write_document(run, report.document, page_data(material));
  return report;
}

Report unwritten_report(RunResults run) {
  expect_cells(run);
  Report report;
  report.run = std::move(run);
  report.summary = summarize(report.run);
  report.claims = test_claims(report.run);
  const PaperValues paper = paper_values(report.summary.suite);
  report.document = report_document({report.run, report.summary, report.claims, report.agreements, paper, Pictures()});
  return report;
}

Document write_index(const std::vector<Report>& reports, const fs::path& file) {
  Document document = index_document(reports, file.parent_path());
  write_file(file, html(document, no_episodes()));  // a click leads to the runs' own pages
  return document;
}

}  // namespace lgabench::report
