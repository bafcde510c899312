// What a row was played under, where that is not as its suite has it: names read from pictures. A row says so by its
// identity, and a preset decides whether it has a rank. The board knows of it what this file says, and nothing else.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include <lgabench/record/cell.hpp>

namespace lgabench::leaderboard {

struct Track;

struct Conditions {
  Reading reading{};            // of what the row sees
  std::string reader_sha256{};  // of the model that reads names; "" where the simulator gives them

  /// Whether they are the suite's.
  bool none() const { return reading.none(); }

  static Conditions of(const Cell& cell);
  /// The cell as they have it, whose scenario and answers are set.
  void set(Cell& cell, const Scenario& scenario) const;
  /// @throws InputError for a cell of this installation that was set with something else of the same name.
  void expect_same(const Cell& cell) const;

  /// Why no leaderboard takes the row; "" where one does.
  std::string refusal() const;
  /// Why the row has no rank in a table of that track; "" where it has one.
  std::string why_not_ranked(const Track& track) const;

  /// The conditions by columns of leaderboard.csv, which are also members of cell.json.
  std::vector<std::pair<std::string, std::string>> values() const;
  /// Options of the row's `run`; none where they are the suite's, and its preset ranks no others.
  std::vector<std::string> arguments(const Track& track) const;
  /// What distinguishes the row's name: "+names=read".
  std::string suffix() const { return reading.suffix(); }
  /// What distinguishes the row's name, in parts, "names=read", for which labels.json has words.
  std::vector<std::string> parts() const;
};

}  // namespace lgabench::leaderboard
