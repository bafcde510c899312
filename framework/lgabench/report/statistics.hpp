// Intervals and tests for success rates.
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lgabench::report {

struct Interval {
  double low = 0, high = 1;
};

/// Wilson's score interval for a binomial proportion, 95 % (Wilson 1927; Brown, Cai and DasGupta 2001).
/// `successes` need not be whole: a mean of rates times the episodes behind it. @pre 0 <= successes <= episodes > 0
Interval wilson(double successes, int episodes);

/// Exact two-sided McNemar test of two policies on the same scenes: the probability of a split at least as uneven as
/// `only_first` against `only_second` (scenes that one of them alone won) were both equally good. @pre both >= 0
double mcnemar(int only_first, int only_second);

/// Interval for the difference of two proportions on the same scenes, second minus first, 95 %: Wald's with the
/// shares of scenes that one alone won taken as (k + 1) / (n + 2), which keeps it honest where few or none differ
/// (Bonett and Price 2012). @pre only_first, only_second >= 0, their sum <= episodes > 0
Interval paired_difference(int only_first, int only_second, int episodes);

/// Success rates (or differences of them) of the policies of one scenario, one a training seed.
using Cluster = std::vector<double>;

/// Values of one scenario's policies, by the participant whose answers each stands on ("" where nobody was asked).
class PolicyValues {
 public:
  void add(const std::string& participant, double value) { values_[participant].push_back(value); }
  /// What the bootstrap draws from: the participants, each with the mean over their training seeds, where there are
  /// several; else the policies. @pre not empty
  Cluster cluster() const;

 private:
  std::map<std::string, Cluster> values_;
};

/// Mean over clusters of the mean within each. @pre no cluster is empty, nor the list
double cluster_mean(const std::vector<Cluster>& clusters);

/// 95 % percentile interval of cluster_mean under a two-stage bootstrap, 10,000 times: clusters (scenarios) are drawn
/// with replacement, then within each its rates (training seeds). Episodes of one policy are not drawn anew: they are
/// not independent. `name` seeds the random stream: the same arguments give the same bits. @pre as cluster_mean
Interval cluster_bootstrap(const std::vector<Cluster>& clusters, std::string_view name);

/// Interval of cluster_mean for a table. One policy: Wilson's. More: the bootstrap's, but nowhere narrower than
/// Wilson's on all their episodes, since differences between policies only add to the chance in each, and with a few
/// policies that happen to agree the bootstrap has hardly any width. Arguments as the two; `episodes` in all.
Interval success_interval(const std::vector<Cluster>& clusters, int episodes, std::string_view name);

/// A paired difference with what chance leaves open: 95 % interval, two-sided p.
struct Change {
  double difference = 0;
  Interval interval{-1, 1};
  double p = 1;
};

/// cluster_mean of differences between two arms or methods that are paired scene by scene, a value a policy (or pair of
/// policies); `only_first` and `only_second` count the scenes that one alone won, of `episodes` in all. One policy:
/// paired_difference and McNemar's p. More: the percentile bootstrap's interval and p (twice the share of resamples
/// on the other side of 0, each tail with one added: Davison and Hinkley 1997, 4.2), but the interval nowhere narrower
/// than paired_difference and p nowhere below McNemar's, for success_interval's reason. Arguments as cluster_bootstrap.
Change paired_change(const std::vector<Cluster>& differences, int only_first, int only_second, int episodes,
                     std::string_view name);

/// p values adjusted for having tested them all, in the order given (Holm 1979): refuse those up to .05.
std::vector<double> holm(const std::vector<double>& p);

/// Two-sided p of Wilcoxon's signed-rank test that differences are symmetric about 0 (Wilcoxon 1945). Zeros are left
/// out. Exact up to 25 differences without ties, else the normal approximation with corrections for ties and
/// continuity, as R's wilcox.test. 1 where nothing is left.
double wilcoxon(const std::vector<double>& differences);

/// Student's paired t test of a mean difference (Student 1908). @pre at least two differences
Change paired_t(const std::vector<double>& differences);

}  // namespace lgabench::report
