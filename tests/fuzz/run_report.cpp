// Somebody else's run, reported, and compared with itself. Pictures are made by a process: here each is a word.
#include <lgabench/document/writers.hpp>
#include <lgabench/report/report.hpp>
#include <lgabench/statistics/agreement.hpp>
#include <lgabench/statistics/compare.hpp>

#include "run_files.hpp"

namespace {

using namespace lgabench;

report::Pictures all_pictures(const statistics::RunResults& results) {
  report::Pictures pictures;
  for (const statistics::CellResult& cell : results.cells)
    for (const auto& arm : cell.episodes)
      for (const Episode& episode : arm.second) pictures.scenes[episode.scene] = "PNG";
  return pictures;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fs::path run = fuzz::directory() / "report";
  fuzz::write_run(run, fuzz::text_of(data, size));
  try {
    const statistics::RunResults results = statistics::read_run(run);
    if (results.cells.empty()) return 0;
    const statistics::Summary summary = statistics::summarize(results);
    const std::vector<statistics::Claim> claims = statistics::test_claims(results);
    const std::vector<statistics::EngineAgreement> agreements = statistics::engine_agreement(results);
    const statistics::PaperValues paper = statistics::paper_values(summary.suite);
    canonical(to_json(summary));
    canonical(to_json(summary.suite, claims));
    canonical(to_json(agreements));
    report::to_csv(summary);
    const report::Pictures pictures = all_pictures(results);
    const report::Material material{results, summary, claims, agreements, paper, pictures};
    const document::Document document = report::report_document(material);
    document::terminal(document, run);
    document::markdown(document);
    document::html(document, report::page_data(material));
    for (const document::Grid* grid : document.grids()) document::latex(*grid), document::csv(*grid);
    for (const document::Chart* chart : document.charts()) document::svg(*chart, true), document::pdf(*chart);
    for (const statistics::CellResult& cell : results.cells) {
      const fs::path directory = run / "cells" / cell.key;
      if (!cell.failed) statistics::compare_cells(directory, directory, true);
    }
    report::comparison_text(statistics::compare_runs(results, results));
  } catch (const InputError&) {
  }
  return 0;
}
