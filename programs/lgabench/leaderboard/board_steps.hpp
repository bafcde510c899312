// What labels, the command and the truth add (statistics/steps.hpp), from the entries of one table.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/document/document.hpp>
#include <lgabench/leaderboard/standings.hpp>
#include <lgabench/leaderboard/tracks.hpp>
#include <lgabench/leaderboard/undisputed.hpp>
#include <lgabench/statistics/steps.hpp>

namespace lgabench::leaderboard {

/// A difference of a scenario is one of a command here.
struct BoardSteps {
  struct Played {
    const statistics::Stage* stage;
    const Entry* entry;
    double success;
    std::optional<double> undisputed;
  };
  MainColumn column;
  std::size_t scenarios = 0;
  std::vector<Played> played;           // of the rules of labels one
  std::vector<statistics::Step> steps;  // [i]: from played[i] to played[i + 1]
  statistics::Step read, both;          // what the command read, and both, have beyond the labels
  double best = 0;                      // the success of the best row that is not told the truth

  /// nullptr where the stage was not played. Labels: whichever of them counts here.
  const Played* of(const char* method) const;
  const Played& labels() const { return played[1]; }
};

/// The steps between rows that place what they learned by a heat map, with equal options and shipped answers. None
/// where one that is needed is not among them. Of the suite's main arm, or where the preset lacks it the first of the
/// track. Labels are those of the rule that the track names, or counted ones where that row is not there. Of several
/// rows with such options the one with the frozen answers (Track::answers) counts. `demonstrations`: in place of the
/// suite's main number.
std::optional<BoardSteps> steps_of(const std::vector<Standing>& table, const Track& track = {},
                                   const std::optional<Undisputed>& undisputed = {},
                                   std::optional<int> demonstrations = {});

/// The steps as a table; `name` is the file's that a page offers.
document::Grid steps_grid(const BoardSteps& steps, const std::string& suite, const std::string& name);
/// Success by stage and what the command adds to the labels, a line for each number of demonstrations.
document::Grid curve_grid(const std::vector<BoardSteps>& curve, const std::string& suite, const std::string& name);

}  // namespace lgabench::leaderboard
