// Scenes and seeds drawn again: what moves a mean, and how often chance alone is taken for a difference.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include <lgabench/core/random.hpp>
#include <lgabench/statistics/bootstrap.hpp>
#include <lgabench/statistics/resampled_mean.hpp>

namespace lgabench::statistics {
namespace {

using Values = std::vector<double>;

// Scenes named after `place`.
std::vector<std::string> scenes(std::size_t n, const std::string& place = "") {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < n; ++i) names.push_back(place + std::to_string(i));
  return names;
}

// Policies of one scenario, on shared scenes or each on its own.
Outcomes::Sample sample(const std::vector<Values>& policies, bool shared = true) {
  Outcomes outcomes;
  for (std::size_t i = 0; i < policies.size(); ++i)
    outcomes.add("", scenes(policies[i].size(), shared ? "" : std::to_string(i) + "/"), policies[i]);
  return outcomes.sample();
}

Values alternating(std::size_t n) {
  Values values(n);
  for (std::size_t i = 0; i < n; i += 2) values[i] = 1;
  return values;
}

TEST(Outcomes, TellSharedScenesFromOwn) {
  const Outcomes::Sample shared = sample({{1, 0, 1}, {0, 0, 1}}), own = sample({{1, 0, 1}, {0, 0, 1}}, false);
  EXPECT_TRUE(shared.shared);
  EXPECT_EQ(shared.scenes, 3);
  EXPECT_FALSE(own.shared);
  EXPECT_EQ(own.scenes, 6);
  EXPECT_DOUBLE_EQ(shared.mean(), .5);
  EXPECT_DOUBLE_EQ(mean_outcome({sample({{1}}), sample({{0, 0, .5, .5}})}), .625) << "scenarios weigh alike";
}

TEST(Outcomes, SeveralParticipantsAreDrawnEachOnTheMeanOverTheirSeeds) {
  Outcomes outcomes;
  for (const double won : {1., 1., 0.}) outcomes.add("p01", scenes(2), {won, 0});
  outcomes.add("p02", scenes(2), {1, 1});
  const Outcomes::Sample two = outcomes.sample();
  ASSERT_EQ(two.units.size(), 2u);
  EXPECT_DOUBLE_EQ(two.units[0][0], 2. / 3);
  EXPECT_DOUBLE_EQ(two.mean(), (1. / 3 + 1) / 2);
  Outcomes one;
  for (const double won : {1., 0.}) one.add("p01", scenes(2), {won, 0});
  EXPECT_EQ(one.sample().units.size(), 2u) << "a single person is no level of its own";
}

TEST(Bootstrap, OfOnePolicyIsTheClosedForm) {
  Values won(20, 1);
  std::fill_n(won.begin(), 5, 0);
  EXPECT_EQ(success_interval({sample({won})}, "x").low, wilson(15, 20).low);
  Values differs(20, 0);
  std::fill_n(differs.begin(), 9, 1);
  differs.back() = -1;
  const Change change = paired_change({sample({differs})}, "x");
  EXPECT_DOUBLE_EQ(change.difference, .4);
  EXPECT_EQ(change.p, mcnemar(1, 9));
  EXPECT_EQ(change.interval.low, paired_difference(1, 9, 20).low);
}

TEST(Bootstrap, DrawsScenes) {
  const double half = 1.96 * std::sqrt(.25 / 400);  // of 400 scenes
  const Values won = alternating(400);
  const Interval shared = success_interval({sample({won, won, won, won})}, "x");
  EXPECT_NEAR(shared.high - shared.low, 2 * half, .15 * half) << "four seeds on the same scenes";
  const Interval own = success_interval({sample({won, won, won, won}, false)}, "x");
  EXPECT_NEAR(own.high - own.low, 2 * half / std::sqrt(3), .15 * half) << "each on its own: three are drawn";
  const Interval scenarios = success_interval({sample({won, won}), sample({won, won}), sample({won, won})}, "x");
  EXPECT_NEAR(scenarios.high - scenarios.low, 2 * half / std::sqrt(3), .15 * half);
}

TEST(Bootstrap, DrawsSeeds) {  // 0, 1/2, 1 with probability 1/4, 1/2, 1/4
  const Interval seeds = success_interval({sample({Values(400, 0), Values(400, 1)})}, "x");
  EXPECT_LT(seeds.low, .01);
  EXPECT_GT(seeds.high, .99);
}

TEST(Bootstrap, TakesTheScenariosAsTheyAre) {
  const Interval fixed =
      success_interval({sample({Values(100, 0), Values(100, 0)}), sample({Values(100, 1), Values(100, 1)})}, "x");
  EXPECT_NEAR(fixed.low, .5, .01);
  EXPECT_NEAR(fixed.high, .5, .01);
}

TEST(Bootstrap, OutcomesThatAllAgreeLeaveWhatTheirScenesLeave) {
  const Interval won = success_interval({sample({Values(20, 1), Values(20, 1), Values(20, 1)})}, "x");
  EXPECT_EQ(won.high, 1);
  EXPECT_NEAR(won.low, wilson(20, 20).low, .05) << "of 20 scenes, not 60 episodes";
  const Change none = paired_change({sample({Values(20, 0), Values(20, 0)})}, "x");
  EXPECT_LT(none.interval.low, -.05);
  EXPECT_GT(none.interval.high, .05);
  EXPECT_GT(none.p, .9);
}

TEST(Bootstrap, PIsNearMcNemarsWhereFewScenesDiffer) {
  for (const int differ : {4, 5, 6, 8, 12}) {
    Values values(400, 0);
    std::fill_n(values.begin(), differ, 1);
    const Change change = paired_change({sample({values}), sample({Values(400, 0)})}, "x");
    EXPECT_NEAR(change.p, mcnemar(0, differ), .3 * mcnemar(0, differ) + .001) << differ;
    std::fill_n(values.begin(), differ, -1);
    EXPECT_NEAR(paired_change({sample({values}), sample({Values(400, 0)})}, "x").p, change.p, .2 * change.p + .003);
  }
}

TEST(Bootstrap, SameNameSameBits) {
  const Samples scenarios{sample({{1, 0, 1, 1, 0}, {0, 0, 1, 1, 1}}), sample({{1, 0, 0}, {0, 0, 1}}, false)};
  const Interval a = success_interval(scenarios, "a"), again = success_interval(scenarios, "a");
  EXPECT_EQ(a.low, again.low);
  EXPECT_EQ(a.high, again.high);
  const Interval b = success_interval(scenarios, "b");
  EXPECT_NEAR(a.low, b.low, .05);
  EXPECT_TRUE(a.low != b.low || a.high != b.high);
}

// Every mean that two draws of units with each three draws of scenes may have, and how probable it is.
std::map<int, double> all_means(const Outcomes::Sample& sample) {
  std::map<int, double> probability;  // of the mean times 6
  const auto value = [&](int unit, int scene) { return static_cast<int>(sample.units[unit][scene]); };
  for (int draw = 0; draw < 729; ++draw) {
    std::array<int, 6> scene{};
    for (int i = 0, rest = draw; i < 6; ++i, rest /= 3) scene[i] = rest % 3;
    if (sample.shared)  // both units have the first three
      for (const auto& [a, b] : {std::pair(0, 0), {0, 1}, {1, 0}, {1, 1}}) {
        int sum = 0;
        for (int i = 0; i < 3; ++i) sum += value(a, scene[i]) + value(b, scene[i]);
        probability[sum] += 1. / 729 / 4;
      }
    else  // one is drawn
      for (const int a : {0, 1})
        probability[2 * (value(a, scene[0]) + value(a, scene[1]) + value(a, scene[2]))] += 1. / 729 / 2;
  }
  return probability;
}

TEST(ResampledMean, IsDistributedAsDrawingSceneByScene) {
  for (const bool shared : {true, false}) {
    const Outcomes::Sample drawn_from = sample({{1, 0, -1}, {1, 1, 0}}, shared);
    ASSERT_TRUE(ResampledMean::pays(drawn_from, 1000));
    ResampledMean mean(drawn_from);
    RandomStream random("means");
    constexpr int draws = 100000;
    std::map<int, int> times;
    for (int i = 0; i < draws; ++i) ++times[static_cast<int>(std::lround(6 * mean.draw(random)))];
    const std::map<int, double> expected = all_means(drawn_from);
    for (const auto& [sum, count] : times) EXPECT_EQ(expected.count(sum), 1u) << sum;
    for (const auto& [sum, p] : expected)
      EXPECT_NEAR(static_cast<double>(times[sum]) / draws, p, 5 * std::sqrt(p / draws)) << shared << ' ' << sum;
  }
}

TEST(ResampledMean, IsForWholeOutcomesOfFewPolicies) {
  EXPECT_FALSE(ResampledMean::pays(sample({{1, 0}, {.5, 1}}), 1000));
  EXPECT_FALSE(ResampledMean::pays(sample({{1}, {0}, {1}, {0}, {1}}), 1000));
  EXPECT_FALSE(ResampledMean::pays(sample({alternating(400)}), 50)) << "its distribution costs more than 50 resamples";
}

TEST(ResampledMean, OfOutcomesThatAllAgreeIsTheirs) {
  for (const double value : {-1., 0., 1.}) {
    const Outcomes::Sample all = sample({Values(20, value), Values(20, value), Values(20, value)}, false);
    RandomStream random("means");
    EXPECT_EQ(ResampledMean(all).draw(random), value);
  }
}

// What follows: two methods without a difference play `scenarios`, again and again.
struct Design {
  int scenarios, seeds, scenes;
  bool shared;
  double seed_share;  // of the variance of what decides success
  double spread;      // standard deviation of a scenario's true difference, whose mean over all scenarios is 0
};

// Whose true difference of two success rates is `difference`, either side of 1/2: where the threshold lies.
double threshold(double difference) {
  double low = -4, high = 4;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (std::erf(middle / std::sqrt(2)) < difference ? low : high) = middle;
  }
  return low;
}

// A scenario's paired differences. Success is a threshold on a sum of effects: the training seed's, the scene's, common
// to both methods or one's own, and the episode's.
std::vector<Values> play(const Design& design, double difference, RandomStream& random) {
  constexpr double common_share = .15, own_share = .3;
  const double at = threshold(difference);
  const auto n = static_cast<std::size_t>(design.scenes);
  Values common(n), own[2] = {Values(n), Values(n)};
  std::vector<Values> policies;
  for (int seed = 0; seed < design.seeds; ++seed) {
    if (seed == 0 || !design.shared)
      for (Values* effects : {&common, &own[0], &own[1]})
        for (double& effect : *effects) effect = random.gaussian();
    const double of_seed[2] = {random.gaussian(), random.gaussian()};
    Values& differences = policies.emplace_back(n);
    for (std::size_t i = 0; i < n; ++i)
      for (const int method : {0, 1}) {
        const double sum = std::sqrt(design.seed_share) * of_seed[method] + std::sqrt(common_share) * common[i] +
                           std::sqrt(own_share) * own[method][i] +
                           std::sqrt(1 - design.seed_share - common_share - own_share) * random.gaussian();
        if (method == 0 ? sum < at : sum < -at) differences[i] += method == 0 ? 1 : -1;
      }
  }
  return policies;
}

using Scenarios = std::vector<std::vector<Values>>;
using Rule = std::function<double(const Scenarios&, const std::string& name)>;  // its p

// How often the rule finds a difference on the mean, where there is none.
double type_1_error(const Design& design, const Rule& p) {
  constexpr int draws = 2000;
  RandomStream random("report_bootstrap_test");
  int found = 0;
  for (int draw = 0; draw < draws; ++draw) {
    Scenarios scenarios;
    for (int s = 0; s < design.scenarios; ++s)
      scenarios.push_back(play(design, std::clamp(design.spread * random.gaussian(), -.9, .9), random));
    found += p(scenarios, std::to_string(draw)) <= .05 ? 1 : 0;
  }
  return static_cast<double>(found) / draws;
}

double these_scenarios(const Scenarios& scenarios, bool shared, const std::string& name) {
  Samples samples;
  for (const auto& policies : scenarios) samples.push_back(sample(policies, shared));
  return paired_change(samples, name, 400).p;
}

double scenarios_like_these(const Scenarios& scenarios, const std::string&) {
  Values means;
  for (const auto& policies : scenarios) means.push_back(sample(policies).mean());
  return paired_t(means).p;
}

// The rule of 0.1.0: scenarios drawn with replacement, then their training seeds; p nowhere below McNemar's on all
// episodes.
double drawn_scenarios(const Scenarios& scenarios, const std::string& name) {
  constexpr int resamples = 400;
  int only_first = 0, only_second = 0;
  std::vector<Values> rates;
  for (const auto& policies : scenarios) {
    Values& rate = rates.emplace_back();
    for (const Values& values : policies) {
      only_first += static_cast<int>(std::count(values.begin(), values.end(), -1.0));
      only_second += static_cast<int>(std::count(values.begin(), values.end(), 1.0));
      rate.push_back(sample({values}).mean());
    }
  }
  RandomStream random(name);
  int below = 0, above = 0;
  for (int i = 0; i < resamples; ++i) {
    double sum = 0;
    for (std::size_t s = 0; s < rates.size(); ++s) {
      const Values& rate = rates[random.below(static_cast<std::uint32_t>(rates.size()))];
      for (std::size_t j = 0; j < rate.size(); ++j) sum += rate[random.below(static_cast<std::uint32_t>(rate.size()))];
    }
    below += sum <= 1e-12 ? 1 : 0;
    above += sum >= -1e-12 ? 1 : 0;
  }
  return std::max(mcnemar(only_first, only_second), std::min(1., 2. * (std::min(below, above) + 1) / (resamples + 1)));
}

constexpr double at_most = .07;

TEST(TypeIError, OnTheseScenarios) {
  for (const Design& d : {Design{4, 3, 20, true, .05, 0}, Design{13, 3, 20, true, .05, 0}, Design{4, 1, 20, true, 0, 0},
                          Design{4, 3, 20, false, .05, 0}})
    EXPECT_LE(type_1_error(d, [&d](const auto& s, const auto& name) { return these_scenarios(s, d.shared, name); }),
              at_most)
        << d.scenarios << " " << d.seeds << " " << d.shared;
}

TEST(TypeIError, OnScenariosLikeThese) {
  for (const int scenarios : {6, 13})
    for (const double spread : {.15, .30})
      EXPECT_LE(type_1_error({scenarios, 3, 20, true, .05, spread}, scenarios_like_these), at_most)
          << scenarios << " " << spread;
}

TEST(TypeIError, OfDrawingFewScenariosIsTooHigh) {
  EXPECT_GT(type_1_error({6, 3, 20, true, .05, .30}, drawn_scenarios), at_most);
}

// How often the interval over commands holds the mean over all commands that there could be. docs/protocol.md has the
// numbers: fewer than 95 % where commands' differences are skewed, or most lie at a bound.
TEST(OverClusters, CoverWhatTheyPromise) {
  const auto normal = [](RandomStream& random) {
    return .2 +
           .2 * std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * 3.141592653589793 * random.uniform());
  };
  const auto skewed = [](RandomStream& random) { return std::pow(random.uniform(), 2); };
  const auto at_a_bound = [](RandomStream& random) { return 1 - std::pow(random.uniform(), 4); };
  struct Commands {
    const char* name;
    std::function<double(RandomStream&)> draw;
    double mean, least;
  };
  for (const Commands& commands : {Commands{"normal", normal, .2, .94}, Commands{"skewed", skewed, 1. / 3, .91},
                                   Commands{"at a bound", at_a_bound, .8, .84}})
    for (std::size_t n = least_clusters; n <= 14; n += 2) {
      RandomStream random(std::string(commands.name) + std::to_string(n));
      constexpr int trials = 10000;
      int held = 0;
      for (int trial = 0; trial < trials; ++trial) {
        Values values;
        for (std::size_t i = 0; i < n; ++i) values.push_back(commands.draw(random));
        const Interval interval = *over_clusters(values, Values(n, 1), {mean(values), mean(values)});
        held += interval.low <= commands.mean && commands.mean <= interval.high;
      }
      const double coverage = 1. * held / trials;
      RecordProperty(std::string(commands.name) + std::to_string(n), std::to_string(coverage));
      EXPECT_GE(coverage, commands.least) << commands.name << " " << n;
      EXPECT_LE(coverage, .96) << commands.name << " " << n;
    }
}

TEST(OverClusters, AreUndecidedBelowSixAndNoNarrowerThanWithinThem) {
  EXPECT_FALSE(over_clusters(Values(5, .2), Values(5, 1), {.1, .3}));
  const Interval alike = *over_clusters(Values(6, .2), Values(6, 1), {.1, .3});
  EXPECT_EQ(alike.low, .1);
  EXPECT_EQ(alike.high, .3);
  const Values values{.1, .2, .3, .4, .5, .9};
  const Interval equal = *over_clusters(values, Values(6, 2), {.4, .4}), t = paired_t(values).interval;
  EXPECT_NEAR(equal.low, t.low, 1e-12);
  EXPECT_NEAR(equal.high, t.high, 1e-12);
  const Interval heavy = *over_clusters(values, {1, 1, 1, 1, 1, 5}, {.6, .6});
  EXPECT_NEAR((heavy.low + heavy.high) / 2, .6, 1e-12) << "the mean, each by its weight";
}

}  // namespace
}  // namespace lgabench::statistics
