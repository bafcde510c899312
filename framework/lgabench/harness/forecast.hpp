// Forecasts what a run has still to do.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/harness/costs.hpp>
#include <lgabench/harness/questions.hpp>

namespace lgabench {

/// Cells to compute, and what that is expected to take.
struct Forecast {
  struct Row {
    std::string name;
    std::size_t cells = 0, there = 0;  // all of them, and those that are finished
    double seconds = 0;                // of one core, for the others
    std::string based_on;              // whose cells took so long
    bool unknown = false;              // nobody knows what the method takes: `seconds` are without it
  };
  std::vector<Row> rows;  // in the order of the cells
  std::size_t cells = 0, there = 0;
  double work_s = 0, longest_s = 0;  // of one core: all cells, the longest
  double wall_s = 0;
  bool unknown = false;                   // a row is: all seconds are the least that it takes
  std::optional<Questions> questions;     // asked before the cells, where any are
  double run_bytes = 0, cache_bytes = 0;  // more on the disk; of the cache at most

  /// "about 1 h 25 min", or "unknown, at least 1 h 25 min".
  std::string duration() const;
  /// "1365 cells to compute, 26 already computed: about 1 h 25 min with 2 workers"; "PURPOSE: 1365 cells, about ..."
  std::string text(int jobs, const std::string& purpose = "") const;
};

/// `costs` has learnt from the complete cells. With more jobs than cores, cores count. `is_unknown`: whether nobody
/// has measured what a cell's row takes; this run's cells then say it alone. It is asked of one cell of a row.
Forecast forecast(const std::vector<const Cell*>& complete, const std::vector<const Cell*>& missing, const Costs& costs,
                  int jobs, const std::function<bool(const Cell&)>& is_unknown);

/// "40 s", "12 min" or "1 h 25 min".
std::string duration_text(double seconds);

/// "950 KB", "47 MB" or "1.2 GB".
std::string size_text(double bytes);

}  // namespace lgabench
