// Somebody else's run, reported, and compared with itself. Figures and pictures are made by processes: there is none of
// the former, and a word in place of each of the latter.
#include <lgabench/report/agreement.hpp>
#include <lgabench/report/compare.hpp>
#include <lgabench/report/html.hpp>
#include <lgabench/report/tables.hpp>

#include "run_files.hpp"

namespace {

using namespace lgabench;

report::Pictures all_pictures(const report::RunResults& results) {
  report::Pictures pictures;
  for (const report::CellResult& cell : results.cells)
    for (const auto& arm : cell.episodes)
      for (const report::PlayedEpisode& episode : arm.second) pictures.scenes[episode.scene] = "PNG";
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
    plain_text(results, summary);
    const std::vector<std::vector<report::Figure>> no_figures(summary.tables.size());
    markdown(results, summary, claims, agreements, paper, no_figures);
    html(results, summary, claims, agreements, paper, all_pictures(results));
    for (const report::CellResult& cell : results.cells) {
      const fs::path directory = run / "cells" / cell.key;
      if (!cell.failed) report::compare_cells(directory, directory, true);
    }
    comparison_text(report::compare_runs(results, results));
  } catch (const InputError&) {
  }
  return 0;
}
