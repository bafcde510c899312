// Intervals and tests in closed form. bootstrap.hpp draws again.
#pragma once
#include <optional>
#include <vector>

namespace lgabench::statistics {

constexpr double alpha = .05;               // of every test: refused are p up to it
constexpr double z_95 = 1.959963984540054;  // standard normal quantile at .975

/// @pre there is a value
double mean(const std::vector<double>& values);

struct Interval {
  double low = 0, high = 1;
};

/// Wilson's score interval for a binomial proportion, 95 % (Wilson 1927; Brown, Cai and DasGupta 2001).
/// `successes` need not be whole: a mean of rates times the episodes behind it. @pre 0 <= successes <= episodes > 0
Interval wilson(double successes, int episodes);

/// Exact two-sided McNemar test of two policies on the same scenes: the probability of a split at least as uneven as
/// `only_first` against `only_second` (scenes in which one of them alone succeeded) were both equally good. @pre both
/// >= 0
double mcnemar(int only_first, int only_second);

/// Interval for the difference of two proportions on the same scenes, second minus first, 95 %: Wald's with the
/// shares of scenes in which one alone succeeded taken as (k + 1) / (n + 2), which keeps it honest where few or none
/// differ (Bonett and Price 2012). @pre only_first, only_second >= 0, their sum <= episodes > 0
Interval paired_difference(int only_first, int only_second, int episodes);

/// A paired difference with what chance leaves open: 95 % interval, two-sided p.
struct Change {
  double difference = 0;
  Interval interval{-1, 1};
  double p = 1;
};

/// p values adjusted for having tested them all, in the order given (Holm 1979): refuse those up to alpha.
std::vector<double> holm(const std::vector<double>& p);

/// Two-sided p of Wilcoxon's signed-rank test that differences are symmetric about 0 (Wilcoxon 1945). Zeros are left
/// out. Exact up to 25 differences without ties, else the normal approximation with corrections for ties and
/// continuity, as R's wilcox.test. 1 where nothing is left.
double wilcoxon(const std::vector<double>& differences);

/// Student's paired t test of a mean difference (Student 1908). @pre at least two differences
Change paired_t(const std::vector<double>& differences);

/// Fewer clusters (commands, persons) say nothing of others like them: their interval is undecided.
constexpr std::size_t least_clusters = 6;

/// 95 % interval of the mean over clusters that were drawn, by Student's t: each cluster's value counts its weight, and
/// the variance is the linearised one (Särndal, Swensson and Wretman 1992). It is no narrower than `within`, which says
/// what chance does to these clusters: clusters that all agree do not make certain. None below least_clusters.
/// interval_coverage_test.cpp simulates its coverage. @pre as many weights as values, above 0
std::optional<Interval> over_clusters(const std::vector<double>& values, const std::vector<double>& weights,
                                      const Interval& within);

/// Welch's t test of the difference of two means, first minus second (Welch 1947). @pre at least two values each
Change welch_t(const std::vector<double>& first, const std::vector<double>& second);

/// Ordinary least squares: each coefficient of `values` on the columns of `rows` with its 95 % interval and Student's
/// p. Empty where there are no more rows than columns, or the columns do not tell their coefficients apart.
/// @pre rows of one length, as many as values
std::vector<Change> least_squares(const std::vector<std::vector<double>>& rows, const std::vector<double>& values);

/// The weights of values at the places `at` in the slope of the line of least squares through them. @pre two places
/// differ
std::vector<double> slope_weights(const std::vector<double>& at);

/// Mean with the standard deviation of the values and the standard error of the mean; one value alone has neither.
/// @pre at least one value
struct Spread {
  double mean = 0;
  std::optional<double> sd, se;
};
Spread spread(const std::vector<double>& values);

}  // namespace lgabench::statistics
