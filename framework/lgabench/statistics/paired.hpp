// Pairs of commands on one scene, and how far episodes of several steps came.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/statistics/pairs.hpp>
#include <lgabench/statistics/results.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::statistics {

using Cells = std::vector<const CellResult*>;

/// A share as Row::success is one, with its 95 % interval.
struct Rate {
  double share = 0;
  Interval interval;
  int scenes = 0;  // distinct ones
};

/// One policy's pairs of two commands: of each scene that both were given in (Episode::pair), 1 where both episodes
/// succeeded, else 0.
struct PolicyOnPairs {
  std::string commands;  // whose pair it is: the scenario, or "ONE + OTHER" where each gives one of the commands
  std::vector<std::string> scenes;
  std::vector<double> won;
};
/// By commands. A scene of which only one command was given is left out. @pre `cells` are one policy's, in several
/// scenarios, and finished
std::vector<PolicyOnPairs> pairs_of_policy(const Cells& cells, const std::string& arm);

/// The share of a row's pairs of which both episodes succeeded: a mean over pairs of commands, with scenes and training
/// seeds drawn again as for any success.
struct PairedSuccess : Rate {
  std::optional<Interval> over_commands;                      // 95 %, of other pairs of commands too; none: undecided
  std::vector<std::pair<std::string, double>> by_commands{};  // whose mean it is
};
/// None where no pair was played whole. Failed cells are left out. `name` seeds the random stream.
std::optional<PairedSuccess> paired_success(const Cells& cells, const std::string& arm, const std::string& name);
Json to_json(const PairedSuccess& paired);

/// How far a row's episodes came whose commands say how objects are used.
struct Course {
  double progress = 0;                    // mean over scenarios of Progress::share(); 0 of one without a step
  int too_early = 0, went_on = 0;         // episodes: said to be done before all was, or not said when all was
  std::optional<Rate> first_take;         // right ones, of episodes in which something had to be taken
  std::optional<Rate> refusals, takings;  // successes, where nothing had to be taken and where something had
};
/// None where no episode says. An episode without a step counts as one in which something had to be taken.
std::optional<Course> course_of(const Cells& cells, const std::string& arm, const std::string& name);
Json to_json(const Course& course);

/// Two rows' cells of each policy, by training seed and participant.
using BothRows = std::map<std::pair<long long, std::string>, std::pair<Cells, Cells>>;
/// The policies on the pairs that both rows played whole: a scenario is a pair of commands.
PairedRow both_on_pairs(const BothRows& policies, const std::string& arm);

}  // namespace lgabench::statistics
