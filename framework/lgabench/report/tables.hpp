// The texts of a report, from its values.
#pragma once
#include <string>
#include <vector>

#include <lgabench/report/figure.hpp>
#include <lgabench/report/paper.hpp>
#include <lgabench/report/summary.hpp>

namespace lgabench::report {

/// "0.85 [0.64, 0.95]", then † and ‡ for the row's marks; "–" for a row without episodes, "" where there is no row.
std::string success_text(const Row* row);

/// What a reader of the tables must know, one line each: what † and ‡ say, whose Selections are no measurement of
/// people, cells that have not run, that the run is not for the leaderboard.
std::vector<std::string> notes(const RunResults& run, const Summary& summary);

/// report.md. `figures` in the order of the summary's tables.
std::string markdown(const RunResults& run, const Summary& summary, const PaperValues& paper,
                     const std::vector<Figure>& figures);

/// The terminal's table.
std::string plain_text(const RunResults& run, const Summary& summary);

}  // namespace lgabench::report
