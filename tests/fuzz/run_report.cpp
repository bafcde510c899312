// Somebody else's run, reported, and compared with itself. No figure is drawn and no picture: those are processes.
#include <lgabench/report/agreement.hpp>
#include <lgabench/report/compare.hpp>
#include <lgabench/report/html.hpp>
#include <lgabench/report/tables.hpp>

#include "run_files.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lgabench;
  const fs::path run = fuzz::directory() / "report";
  fuzz::write_run(run, fuzz::text_of(data, size));
  try {
    const report::RunResults results = report::read_run(run);
    if (results.cells.empty()) return 0;
    const report::Summary summary = report::summarize(results);
    const std::vector<report::Claim> claims = report::test_claims(results);
    const std::vector<report::EngineAgreement> agreements = report::engine_agreement(results);
    const report::PaperValues paper = report::paper_values(summary.suite);
    canonical(to_json(summary));
    canonical(to_json(summary.suite, claims));
    canonical(to_json(agreements));
    to_csv(summary);
    plain_text(results, summary);
    markdown(results, summary, claims, agreements, paper, {});
    html(results, summary, claims, agreements, paper, {});
    for (const report::CellResult& cell : results.cells) {
      const fs::path directory = run / "cells" / cell.key;
      if (!cell.failed) report::compare_cells(directory, directory, true);
    }
    comparison_text(report::compare_runs(results, results));
  } catch (const InputError&) {
  }
  return 0;
}
