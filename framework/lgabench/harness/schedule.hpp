// Which cells are played where, and in which order. Neither changes a result.
#pragma once
#include <map>
#include <string>
#include <vector>

#include <lgabench/harness/cell.hpp>

namespace lgabench {

/// One of several parts of a run, each played on its own.
struct Shard {
  int index = 1, count = 1;
};

/// Reads "i/n". @throws InputError for anything else, or an i that is not from 1 to n.
Shard read_shard(const std::string& text);

/// The shard's cells. Cells are dealt out like cards, those of one row and number of demonstrations one after the
/// other: every shard gets its share of each kind, whatever a kind costs. A function of the cells alone.
std::vector<const Cell*> cells_of(const std::vector<Cell>& cells, Shard shard);

/// Gives out cells, those that are expected to take longest first, so that no worker ends long after the others. It
/// learns from the cells that are done how long each row's method takes for a demonstration.
class Schedule {
 public:
  /// The cells must outlive it.
  explicit Schedule(std::vector<const Cell*> cells) : left_(std::move(cells)) {}

  /// What a cell of this run took, played now or earlier.
  void learn(const Cell& cell, double seconds);
  /// The next one: of the rows that nothing is known of yet the one with most demonstrations, then by expected time.
  /// @pre not all were given.
  const Cell* next();

 private:
  struct Cost {
    double seconds = 0, demonstrations = 0;
  };
  std::vector<const Cell*> left_;
  std::map<std::string, Cost> known_;  // by the row's name
};

}  // namespace lgabench
