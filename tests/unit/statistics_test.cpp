#include <gtest/gtest.h>

#include <cmath>

#include <lgabench/statistics/statistics.hpp>

namespace lgabench::statistics {
namespace {

// Newcombe, Statistics in Medicine 17 (1998), table I, score method without continuity correction.
TEST(Wilson, PublishedValues) {
  struct Case {
    int successes, episodes;
    double low, high;
  };
  for (const Case& c : {Case{81, 263, .2553, .3662}, Case{15, 148, .0624, .1605}, Case{0, 20, 0, .1611},
                        Case{1, 29, .0061, .1718}, Case{15, 20, .5313, .8881}}) {
    const Interval interval = wilson(c.successes, c.episodes);
    EXPECT_NEAR(interval.low, c.low, 5e-5) << c.successes << "/" << c.episodes;
    EXPECT_NEAR(interval.high, c.high, 5e-5) << c.successes << "/" << c.episodes;
  }
}

TEST(Wilson, ReachesTheEndsExactlyAndIsSymmetric) {
  EXPECT_EQ(wilson(0, 20).low, 0);
  EXPECT_EQ(wilson(20, 20).high, 1);
  EXPECT_NEAR(wilson(20, 20).low, 1 - wilson(0, 20).high, 1e-15);
}

// 2 sum_{k <= min} C(n, k) / 2^n in exact fractions (Python's fractions.Fraction), then rounded to a double.
TEST(McNemar, ExactFractions) {
  EXPECT_NEAR(mcnemar(1, 9), 0.021484375, 1e-14);
  EXPECT_NEAR(mcnemar(5, 15), 0.04138946533203125, 1e-14);
  EXPECT_NEAR(mcnemar(15, 5), 0.04138946533203125, 1e-14);
  EXPECT_NEAR(mcnemar(0, 5), 0.0625, 1e-15);
  EXPECT_EQ(mcnemar(0, 0), 1);
  EXPECT_EQ(mcnemar(7, 7), 1);
  EXPECT_NEAR(mcnemar(3000, 3200), 0.011488253770871206, 1e-12);  // 2^-6200 is no double
}

// How often the interval holds the truth, summed over every outcome of n scenes with its multinomial probability.
double coverage(double only_first, double only_second, int n) {
  const double neither = 1 - only_first - only_second, truth = only_second - only_first;
  double covered = 0;
  for (int b = 0; b <= n; ++b)
    for (int c = 0; b + c <= n; ++c) {
      const Interval interval = paired_difference(b, c, n);
      if (interval.low <= truth && truth <= interval.high)
        covered += std::exp(std::lgamma(n + 1) - std::lgamma(b + 1) - std::lgamma(c + 1) - std::lgamma(n - b - c + 1)) *
                   std::pow(only_first, b) * std::pow(only_second, c) * std::pow(neither, n - b - c);
    }
  return covered;
}

TEST(PairedDifference, CoversTheTruthAboutAsOftenAsItSays) {
  for (const int n : {20, 100})
    for (const double only_first : {.02, .1, .3, .5})
      for (const double only_second : {.02, .1, .3}) {
        EXPECT_GT(coverage(only_first, only_second, n), .93) << only_first << " " << only_second << " " << n;
        if (only_first + only_second >= .2) {  // else few outcomes are likely at all
          EXPECT_LT(coverage(only_first, only_second, n), .985) << only_first << " " << only_second << " " << n;
        }
      }
}

TEST(PairedDifference, HasASignAndStaysWithinOne) {
  const Interval a = paired_difference(3, 11, 40), b = paired_difference(11, 3, 40);
  EXPECT_NEAR(a.low, -b.high, 1e-15);
  EXPECT_NEAR(a.high, -b.low, 1e-15);
  EXPECT_GT(a.low + a.high, 0);
  EXPECT_EQ(paired_difference(0, 20, 20).high, 1);
}

// What follows: statistics_reference.py (SciPy, statsmodels), but where another source is named.
TEST(Holm, ReferenceValuesInTheOrderGiven) {
  const std::vector<double> p{.011, .3, .0004, .02, .02, .9, .013}, expected{.066, .6, .0028, .08, .08, .9, .066};
  ASSERT_EQ(holm(p).size(), p.size());
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(holm(p)[i], expected[i], 1e-12) << i;
  EXPECT_EQ(holm({.8, .9}), (std::vector<double>{1, 1}));
  EXPECT_TRUE(holm({}).empty());
}

// Hollander and Wolfe (1973), p. 29: Hamilton depression scale before and after. V = 40, one-sided p .01953 (R's
// manual).
const std::vector<double> depression{1.83 - .878, .5 - .647,   1.62 - .598, 2.48 - 2.05, 1.68 - 1.06,
                                     1.88 - 1.29, 1.55 - 1.06, 3.06 - 3.14, 1.3 - 1.29};
// Student (1908): sleep gained by ten patients under two drugs.
const std::vector<double> sleep{1.2, 2.4, 1.3, 1.3, 0, 1, 1.8, .8, 4.6, 1.4};

std::vector<double> alternating(int n, double step) {
  std::vector<double> d;
  for (int i = 1; i <= n; ++i) d.push_back(step * i * (i % 3 == 1 ? -1 : 1));
  return d;
}

TEST(Wilcoxon, ExactReferenceValues) {
  EXPECT_NEAR(wilcoxon(depression), .0390625, 1e-15);
  EXPECT_NEAR(wilcoxon(alternating(25, .5)), .23036134243011475, 1e-14);
  EXPECT_NEAR(wilcoxon({1, 2, 3, 4, 5, 6}), .03125, 1e-15);
  EXPECT_NEAR(wilcoxon({-1, -2, -3, -4, -5, -6}), .03125, 1e-15);
}

TEST(Wilcoxon, NormalApproximationWithTiesZerosAndContinuity) {
  EXPECT_NEAR(wilcoxon(sleep), .009090698015925044, 1e-14);
  std::vector<double> tied;
  for (int i = 0; i < 60; ++i) tied.push_back(i % 7 - 2);
  EXPECT_NEAR(wilcoxon(tied), .0015515548156511737, 1e-14);
  EXPECT_NEAR(wilcoxon(alternating(26, .25)), .14072874277056632, 1e-14);
  EXPECT_EQ(wilcoxon({0, 0}), 1);
  EXPECT_EQ(wilcoxon({1, -1}), 1);
}

TEST(PairedT, ReferenceValues) {
  const Change s = paired_t(sleep);  // R's manual: p .002833, interval .7001142 to 2.4598858
  EXPECT_NEAR(s.difference, 1.58, 1e-12);
  EXPECT_NEAR(s.interval.low, .7001142367230174, 1e-12);
  EXPECT_NEAR(s.interval.high, 2.4598857632769824, 1e-12);
  EXPECT_NEAR(s.p, .002832890197384273, 1e-12);
  const Change a = paired_t(alternating(25, .5));
  EXPECT_NEAR(a.interval.low, -1.21615309175715, 1e-12);
  EXPECT_NEAR(a.p, .2279858673327479, 1e-12);
  EXPECT_EQ(paired_t({0, 0}).p, 1);
  EXPECT_EQ(paired_t({2, 2}).p, 0);
}

}  // namespace
}  // namespace lgabench::statistics
