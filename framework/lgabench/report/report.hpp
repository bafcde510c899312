// From a run directory to what people read: tables, figures, and the values behind them.
#pragma once
#include <string>

#include <lgabench/core/files.hpp>

namespace lgabench::report {

/// Reads RUN's cells, writes RUN/summary.json, summary.csv, claims.json, report.md, report.html and figures/*.svg. The
/// same cells give the same bytes, but for the times in report.md and report.html. Without gnuplot the report says so
/// and has no figure; without lgabench-worker beside the program report.html says so and has no pictures.
/// @throws InputError naming the file and the line for a run that cannot be read or written.
void write_report(const fs::path& run);

/// The table for a terminal, fixed width, without colour: a block a scenario and one for their mean; success with its
/// 95 % interval for each method and number of demonstrations (with several arms: for each arm, and the change against
/// the first one where they are paired), reference rows below a rule, failed cells last.
/// @throws InputError as write_report does.
std::string table_text(const fs::path& run);

}  // namespace lgabench::report
