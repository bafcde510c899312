// From a run directory to what people read: tables, figures, and the values behind them.
#pragma once
#include <vector>

#include <lgabench/core/files.hpp>
#include <lgabench/report/headline.hpp>
#include <lgabench/report/report_document.hpp>
#include <lgabench/statistics/compare.hpp>

namespace lgabench::report {
using namespace document;
using namespace statistics;

/// What a run's report is made of. Not to be copied: agreements name cells of the run.
struct Report {
  Report() = default;
  Report(Report&&) = default;

  RunResults run;
  Summary summary;
  std::vector<Claim> claims;
  std::vector<EngineAgreement> agreements;
  Document document;
  Brief brief;
};

/// Reads RUN's cells, writes RUN/summary.json, summary.csv, episodes.csv, claims.json, report.md, report.html, each
/// figure as SVG and PDF in figures/, and each table as LaTeX and CSV in tables/. The same cells give the same bytes,
/// but for the times in report.md and report.html. Without lgabench-worker beside the program report.html says so and
/// has no pictures.
/// @throws InputError naming the file and the line for a run that cannot be read or written.
Report write_report(const fs::path& run);

/// The report that write_report() would write of these results. Writes nothing, and has no pictures.
/// @throws InputError where no cell was played
Report unwritten_report(RunResults run);

/// summary.csv, and episodes.csv: a line for each episode of the run (docs/formats).
std::string to_csv(const Summary& summary);
std::string episodes_csv(const RunResults& run);

/// Below the verdict, tables for a terminal, with `each_phase` of the seconds of all phases.
std::string comparison_text(const RunComparison& comparison, bool each_phase = false);

/// Writes `file`, a page over several runs that have a report. Returns its document.
Document write_index(const std::vector<Report>& reports, const fs::path& file);

}  // namespace lgabench::report
