// Which cells are played where, and in which order. Neither changes a result.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/harness/costs.hpp>
#include <lgabench/record/cell.hpp>

namespace lgabench {

/// One of several parts of a run, each played on its own.
struct Shard {
  int index = 1, count = 1;
};

/// Reads "i/n". @throws InputError for anything else, or an i that is not from 1 to n.
Shard read_shard(const std::string& text);

/// The shard's cells. Cells are dealt out in turn, those of one row and number of demonstrations one after the other:
/// every shard gets its share of each kind, whatever a kind costs. A function of the cells alone.
std::vector<const Cell*> cells_of(const std::vector<Cell>& cells, Shard shard);

/// Gives out cells, those that are expected to take longest first, so that no worker ends long after the others. It
/// learns from the cells that are done how long each row's take.
class Schedule {
 public:
  /// The cells must outlive it. With a number they are given out in the order that it draws, whatever they take.
  explicit Schedule(const std::vector<const Cell*>& cells, std::optional<std::uint32_t> drawn_by = std::nullopt,
                    Costs learnt = {});

  /// What a cell of this run took, played now or earlier.
  void learn(const Cell& cell, double seconds) { costs_.learn(cell, seconds); }
  const Costs& costs() const { return costs_; }
  /// Seconds of one worker for all that were not given out yet.
  double left_s() const;
  /// The next one: of the rows that nothing is known of yet the one that usually takes longest, then by expected time.
  /// @pre not all were given.
  const Cell* next();

 private:
  struct Waiting {
    const Cell* cell;
    double usual_s;
    std::size_t place;  // in the order given, or drawn: of two that take as long the earlier goes first
  };
  // What is known of one row; new timings change all of its cells alike, so that their order stays.
  struct Row {
    std::string name;
    std::vector<Waiting> left;  // the longest last, or the first that was drawn
    double usual_s = 0;         // over all of them
  };

  bool drawn_;
  std::vector<Row> rows_;  // that have cells left
  Costs costs_;
};

}  // namespace lgabench
