// The standings of one table: scores, intervals and ranks, from the outcomes alone.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/leaderboard/admission.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::leaderboard {

/// Means over scenarios of the share of units (units.hpp) that were won; those of a cell that the method failed are
/// lost.
struct Means {
  double score = 0;          // over all arms and numbers of demonstrations
  std::map<int, double> at;  // by number of demonstrations; 0 of a row that learns nothing
  std::map<std::string, double> in_arm, in_scenario;
};

/// An entry in its table. In a perturbed table (areas.hpp) score, interval, rates by
/// demonstrations and by scenario are of areas under the curves of success against levels, over axes.
struct Standing : Means {
  const Entry* entry = nullptr;
  std::optional<Means> each;      // of its episodes, where the unit is a pair of them
  statistics::Interval interval;  // 95 %, of the score
  std::optional<int> rank;    // 1 + the entries that are significantly better, and no less than that of an entry with
                              // more success; none where it is not ranked
  std::string not_ranked;     // why; "" where it is ranked
  bool below_random = false;  // its score is below that of the reference row random_object
  std::map<std::string, std::optional<double>> areas;  // by axis, relative to the control
  /// In the abstraction track: success over the arms that its file names, and how much of the distance from the mask of
  /// any object to that of the truth it closes there; none where one of those two is no row of the table.
  std::optional<double> in_track, gap_closed;
  int episodes = 0, failed_cells = 0;
  std::optional<double> precision, recall;  // of its Selections, mean over commands and kinds of features
  int cells_not_asked = 0;  // whose recorded answers are lists: nobody was asked the questions that they count
  double lm_queries = 0, lm_tokens = 0, learn_s = 0;  // of a cell that did not fail, on average
};

/// Shares of units that were won by scenario (and layout), training seed and test scene (pair of scenes).
using Rates = std::vector<std::vector<std::vector<double>>>;
/// An entry's, over all arms and numbers of demonstrations; with an arm those of it alone, at one number of
/// demonstrations, in the scenarios that have it.
Rates rates_of(const Entry& entry, const std::string& only_arm = "", int only_demonstrations = 0);

/// The entries of one ranking by score, among them those that have no rank. Entries that were withdrawn, or not yet
/// replayed, are left out. All share their resamples of test scenes and training seeds (statistics/bootstrap.hpp),
/// which makes the paired test of every two of them as cheap as a difference. Holm's correction is over the comparisons
/// of each entry. Deterministic.
/// @pre the entries have one setting
std::vector<Standing> standings(const std::vector<const Entry*>& table, const Track& track = {},
                                Ranking ranking = Ranking::any_policy);

/// The entries of one table whose files are all that is known of them: what they claim, without interval and costs.
std::vector<Standing> not_yet_replayed(const std::vector<const Entry*>& table);

/// Entries that share a table, by suite, preset, its hash and scene seed.
std::vector<std::vector<const Entry*>> tables(const std::vector<Entry>& entries);

}  // namespace lgabench::leaderboard
