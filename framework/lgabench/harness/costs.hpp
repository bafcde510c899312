// What a cell costs in seconds: as measured once, corrected by what this run's cells take.
#pragma once
#include <map>
#include <string>

#include <lgabench/harness/cell.hpp>

namespace lgabench {

/// Seconds of a cell by a table of measured costs (costs.cpp): of its method and network for each demonstration and
/// pass over it, and of each demonstration and episode. `of_its_own` is set to whether the method has an entry; one
/// that has none is taken for LGA.
double usual_seconds(const Cell& cell, bool* of_its_own = nullptr);

/// Learns, row by row, how much longer or shorter cells take here than they usually do.
class Costs {
 public:
  /// What a cell of this run took, played now or earlier.
  void learn(const Cell& cell, double seconds);
  /// Whether a cell of that row was learnt.
  bool knows(const std::string& row) const { return rows_.count(row) != 0; }
  /// Seconds that the cell is expected to take: as much beside the usual as its row's others took, else all others.
  double expected_seconds(const Cell& cell) const { return expected_seconds(cell.method.name, usual_seconds(cell)); }
  /// Likewise of a cell of `row` that usually takes `usual` seconds.
  double expected_seconds(const std::string& row, double usual) const;

 private:
  struct Sum {
    double seconds = 0, usual = 0;
  };
  std::map<std::string, Sum> rows_;  // by name
  Sum all_;
};

}  // namespace lgabench
