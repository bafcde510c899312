// Somebody else's run, reported, and compared with itself. Pictures are made by a process: here each is a word.
#include <lgabench/document/writers.hpp>
#include <lgabench/report/report.hpp>
#include <lgabench/statistics/agreement.hpp>
#include <lgabench/statistics/compare.hpp>

#include "run_files.hpp"

namespace {

using namespace lgabench;

report::Pictures all_pictures(const report::RunResults& results) {
  report::Pictures pictures;
  for (const report::CellResult& cell : results.cells)
    for (const auto& arm : cell.episodes)
      for (const Episode& episode : arm.second) pictures.scenes[episode.scene] = "PNG";
  return pictures;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
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
    const report::Pictures pictures = all_pictures(results);
    const report::Material material{results, summary, claims, agreements, paper, pictures};
    const report::Document document = report::report_document(material);
    report::terminal(document, run);
    report::markdown(document);
    report::html(document, report::page_data(material));
    for (const report::Grid* grid : document.grids()) report::latex(*grid), report::csv(*grid);
    for (const report::Chart* chart : document.charts()) report::svg(*chart, true), report::pdf(*chart);
    for (const report::CellResult& cell : results.cells) {
      const fs::path directory = run / "cells" / cell.key;
      if (!cell.failed) report::compare_cells(directory, directory, true);
    }
    comparison_text(report::compare_runs(results, results));
  } catch (const InputError&) {
  }
  return 0;
}
