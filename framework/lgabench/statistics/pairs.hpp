// Policies that played the same scenes, or one policy in two arms or on two engines, paired episode by episode.
#pragma once
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/statistics/bootstrap.hpp>
#include <lgabench/statistics/results.hpp>

namespace lgabench::statistics {

/// Whether both acted and their actions are bit-identical. Two episodes without an action say nothing about each other.
bool same_action(const Episode& first, const Episode& second);

/// Pairs of episodes, counted.
struct EpisodePairs {
  int episodes = 0, won_first = 0, won_second = 0;
  int only_first = 0, only_second = 0;  // those in which one alone succeeded
  bool same_actions = true;             // same_action() in each

  void add(const Episode& first, const Episode& second);
  /// A pair of which nothing but who succeeded is known.
  void count(bool first_won, bool second_won);
  void add(const EpisodePairs& others);
  int agreed() const { return episodes - only_first - only_second; }
};

/// Two policies on the scenes of one arm, or one in two arms.
struct PolicyPair : EpisodePairs {
  // Each of the second's episodes: its scene, by its hash, and who succeeded, 1 or 0.
  std::vector<std::string> scenes;
  std::vector<double> first, second;

  /// Second minus first, in each episode.
  std::vector<double> differences() const;
};
/// Pairs the episodes of two arms, which have other scenes. None unless they are as many, with the same commands in the
/// same order or, with `commands`, with commands of the same truth, which paraphrase each other.
std::optional<PolicyPair> pair_episodes(const std::vector<Episode>& first, const std::vector<Episode>& second,
                                        const std::vector<CommandResult>& commands);

/// Why the two did not play the same scenes with the same commands in the arm, in one line; empty if they did. @pre
/// both cells finished and have the arm
std::string why_unpaired(const CellResult& first, const CellResult& second, const std::string& arm);

/// @throws InputError, in one line, where why_unpaired() has a reason. @pre as there
PolicyPair pair_policies(const CellResult& first, const CellResult& second, const std::string& arm);

/// Pairs of policies of one row of a table, by scenario and then by training seed, or by participant where a row has
/// several.
class PairedRow {
 public:
  void add(const std::string& scenario, const PolicyPair& pair, const std::string& participant = "");

  const EpisodePairs& total() const { return total_; }  // counts over all pairs
  int scenarios() const { return static_cast<int>(rows_.size()); }
  int policies() const { return policies_; }
  int participants() const { return static_cast<int>(participants_.size()); }
  int scenes() const { return distinct_scenes(samples(&Scenario::differences)); }
  /// Mean over scenarios of the mean over training seeds (participants) of the policies' success. @pre not empty
  double first_success() const { return mean_outcome(samples(&Scenario::first)); }
  double second_success() const { return mean_outcome(samples(&Scenario::second)); }
  /// Second minus first in each scenario, in the order in which the scenarios were added.
  std::vector<std::pair<std::string, double>> by_scenario() const;
  /// paired_change of second minus first: these scenarios, other scenes and seeds. `name` seeds its random stream.
  /// @pre not empty
  Change change(const std::string& name) const { return paired_change(samples(&Scenario::differences), name); }

 private:
  struct Scenario {
    std::string name;
    Outcomes first, second, differences;
  };
  Samples samples(Outcomes Scenario::*which) const;

  std::vector<Scenario> rows_;
  std::set<std::string> participants_;
  int policies_ = 0;
  EpisodePairs total_;
};

/// "+0.10 [-0.03, +0.23]"
std::string change_text(const Change& change);
/// "p = 0.013", "p < 0.001"
std::string p_text(double p);

}  // namespace lgabench::statistics
