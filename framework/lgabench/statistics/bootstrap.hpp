// How far chance may have moved a mean over scenarios, by drawing test scenes and training seeds again.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <lgabench/statistics/statistics.hpp>

namespace lgabench::statistics {

/// What a row's policies did in one scenario, scene by scene: success (0, 1), or a paired difference of it (-1, 0, 1).
class Outcomes {
 public:
  /// One policy's, `values[i]` on the scene with the hash `scenes[i]`. `participant`: whose answers it has, "" for
  /// nobody's. @pre as many scenes as values, at least one; no scene twice
  void add(const std::string& participant, std::vector<std::string> scenes, std::vector<double> values);

  /// What is drawn from: the policies (training seeds), or where there are several participants these, each with the
  /// mean over their seeds on each scene. @pre not empty
  struct Sample {
    std::vector<std::vector<double>> units;  // of each policy or participant: an outcome for each scene it played
    bool shared = false;                     // all played the same scenes: [i][j] is that of unit i on scene j
    int scenes = 0;                          // distinct ones
    /// Mean over units of the mean over their scenes.
    double mean() const;
  };
  Sample sample() const;

 private:
  struct PolicyOutcomes {
    std::string participant;
    std::vector<std::string> scenes;
    std::vector<double> values;
  };
  std::vector<PolicyOutcomes> policies_;
};

/// A row's scenarios.
using Samples = std::vector<Outcomes::Sample>;

/// Mean over scenarios of the mean over policies (participants) of their outcomes. @pre neither list is empty
double mean_outcome(const Samples& scenarios);
/// Distinct test scenes, over all scenarios.
int distinct_scenes(const Samples& scenarios);

// The scenarios are taken as they are: intervals and p say what other test scenes and other training seeds would do on
// them. Within each scenario both are drawn with replacement: crossed where all policies share their scenes (Owen 2007:
// a resample's scenes are the same for each of its policies), else nested, scenes within each policy drawn; there one
// policy fewer than there are, as three drawn of three show two thirds of what differs between them (Rao and Wu 1988).
// With one policy a scenario, only its scenes are drawn, and the result holds for its training seed. Every resample of
// a row draws as well from two imagined scenes, one to either side, as Bonett and Price's interval has them: outcomes
// that all agree do not make certain. Several policies that share 20 scenes are thus 20 scenes, not 60 episodes.
// bootstrap_test.cpp measures the type-I error. `name` seeds the random stream: the same arguments, the same
// bits.

/// 95 % percentile interval of a mean success, 2,000 resamples; Wilson's for a single policy.
Interval success_interval(const Samples& scenarios, std::string_view name);

/// Mean paired difference with its 95 % percentile interval and p, twice the share of resamples on the other side of 0,
/// each tail with one added (Davison and Hinkley 1997, 4.2); for a single pair of policies Bonett and Price's interval
/// and McNemar's p.
Change paired_change(const Samples& scenarios, std::string_view name, int resamples = 10000);

/// Shares 10,000 resamples among many rows that played the same scenes, so that any two of them are paired. The tests
/// above, of every pair, then cost little more than one.
class SharedResamples {
 public:
  /// `rows`: of each row, scenario, policy and scene the success, or a mean of it. `shared`: as Sample::shared;
  /// of a single policy it says nothing. `weights`: what each scenario counts in a mean; as much as any other where
  /// none is given. @pre all rows have as many scenarios, policies and scenes; none is empty
  SharedResamples(const std::vector<std::vector<std::vector<std::vector<double>>>>& rows, bool shared,
                  std::string_view name, const std::vector<double>& weights = {});
  /// As success_interval(), of a row's mean.
  Interval interval(std::size_t row) const;
  /// As paired_change(): two-sided p that two rows are equally good. Where no resample is on the other side of 0 the
  /// tail is a normal distribution's with the resamples' mean and variance, if that is smaller: Holm's correction over
  /// more than 250 rows would otherwise find no difference.
  double p(std::size_t one, std::size_t other) const;
  /// 95 % percentile interval of another row's mean minus a row's.
  Interval difference(std::size_t one, std::size_t other) const;
  /// 95 % percentile interval of a row's mean as a share of another row's; none where in more than 2.5 % of the
  /// resamples that other one is 0.
  std::optional<Interval> ratio(std::size_t row, std::size_t to) const;

 private:
  double scenes_ = 0;
  std::vector<std::vector<float>> means_;      // of each row, in each resample: over what was drawn
  std::vector<std::pair<int, int>> imagined_;  // of each resample, how often either imagined scene was drawn
};

}  // namespace lgabench::statistics
