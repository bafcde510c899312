// A cell's expected seconds: as measured once, corrected by what this run's cells take.
#pragma once
#include <map>
#include <string>

#include <lgabench/record/cell.hpp>

namespace lgabench {

/// Seconds of a cell by what was measured once (the data directory's measured/costs.json): of its method and network
/// for each demonstration and pass over it, and of each demonstration and episode. @throws InputError
double usual_seconds(const Cell& cell);
/// usual_seconds() without those that the method takes to learn.
double least_seconds(const Cell& cell);
/// The measured method that stands in for a cell's unmeasured one; "" if the cell's was measured.
std::string measured_on(const Cell& cell);

/// Learns, row by row, how much longer or shorter cells take here than they usually do.
class Costs {
 public:
  /// What a cell of this run took, played now or earlier.
  void learn(const Cell& cell, double seconds);
  /// Whether a cell of that row was learnt.
  bool knows(const std::string& row) const { return rows_.count(row) != 0; }
  /// Seconds that the cell is expected to take: the usual ones, corrected as its row's other cells were, else as all
  /// others.
  double expected_seconds(const Cell& cell) const { return expected_seconds(cell.method.name, usual_seconds(cell)); }
  /// Seconds that a cell of `row` is expected to take, which usually takes `usual`.
  double expected_seconds(const std::string& row, double usual) const;

 private:
  struct Sum {
    double seconds = 0, usual = 0;
  };
  std::map<std::string, Sum> rows_;  // by name
  Sum all_;
};

}  // namespace lgabench
