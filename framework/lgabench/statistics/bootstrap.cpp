#include <lgabench/statistics/bootstrap.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include <lgabench/core/random.hpp>
#include <lgabench/statistics/resampled_mean.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::statistics {
namespace {

// One unit's outcomes by scene: their sum over its policies, and how many played it.
using ByScene = std::map<std::string, std::pair<double, int>>;

bool one_policy(const Samples& scenarios) { return scenarios.size() == 1 && scenarios.front().units.size() == 1; }

// How often one scene of many is drawn in as many draws as there are scenes: Poisson with mean 1.
int times_drawn(RandomStream& random) {
  const double u = random.uniform();
  int times = 0;
  for (double p = std::exp(-1.0), below = p; u >= below && p > 1e-12; p /= times, below += p) ++times;
  return times;
}

// Both lists are room to work in.
double crossed_mean(const Outcomes::Sample& sample, RandomStream& random, std::vector<std::uint32_t>& drawn,
                    std::vector<double>& sums) {
  const auto units = static_cast<std::uint32_t>(sample.units.size()),
             scenes = static_cast<std::uint32_t>(sample.scenes);
  drawn.resize(scenes);
  for (std::uint32_t& scene : drawn) scene = random.below(scenes);
  sums.clear();
  for (const std::vector<double>& unit : sample.units) {  // one at a time: its sum stays in a register
    double sum = 0;
    for (const std::uint32_t scene : drawn) sum += unit[scene];
    sums.push_back(sum);
  }
  double sum = 0;
  for (std::uint32_t i = 0; i < units; ++i) sum += sums[random.below(units)];
  return sum / units / scenes;
}

double nested_mean(const Outcomes::Sample& sample, RandomStream& random) {
  const auto units = static_cast<std::uint32_t>(sample.units.size());
  double sum = 0;
  for (std::uint32_t i = 1; i < units; ++i) {
    const std::vector<double>& values = sample.units[random.below(units)];
    const auto scenes = static_cast<std::uint32_t>(values.size());
    double within = 0;
    for (std::uint32_t j = 0; j < scenes; ++j) within += values[random.below(scenes)];
    sum += within / scenes;
  }
  return sum / (units - 1);
}

// The mean over scenarios in every resample, sorted. `other_side`: an outcome opposite to 1, as the second imagined
// scene has it.
std::vector<double> resampled_means(const Samples& scenarios, double other_side, std::string_view name, int resamples) {
  RandomStream random(name);
  const double scenes = distinct_scenes(scenarios);
  std::vector<double> means(static_cast<std::size_t>(resamples)), sums;
  std::vector<std::uint32_t> drawn;
  std::vector<std::optional<ResampledMean>> fast;  // of each scenario where that pays
  for (const Outcomes::Sample& sample : scenarios) {
    fast.emplace_back();
    if (ResampledMean::pays(sample, resamples)) fast.back().emplace(sample);
  }
  for (double& resampled : means) {
    double sum = 0;
    for (std::size_t s = 0; s < scenarios.size(); ++s)
      sum += fast[s]               ? fast[s]->draw(random)
             : scenarios[s].shared ? crossed_mean(scenarios[s], random, drawn, sums)
                                   : nested_mean(scenarios[s], random);
    const int one = times_drawn(random), other = times_drawn(random);
    resampled =
        (sum / static_cast<double>(scenarios.size()) * scenes + one + other_side * other) / (scenes + one + other);
  }
  std::sort(means.begin(), means.end());
  return means;
}

Interval percentile_interval(const std::vector<double>& sorted) {
  const std::size_t cut = sorted.size() / 40;  // 2.5 % on either side
  return {sorted[cut], sorted[sorted.size() - 1 - cut]};
}

// Two-sided, that the mean is 0.
double percentile_p(const std::vector<double>& sorted) {
  constexpr double rounding = 1e-12;  // of a mean that is 0
  const auto up_to_zero = std::upper_bound(sorted.begin(), sorted.end(), rounding) - sorted.begin();
  const auto from_zero = sorted.end() - std::lower_bound(sorted.begin(), sorted.end(), -rounding);
  return std::min(
      1.0, 2 * (static_cast<double>(std::min(up_to_zero, from_zero)) + 1) / (static_cast<double>(sorted.size()) + 1));
}

// A success, or a mean, of every row beside each other: [scenario][policy][scene][row].
using RowsByScene = std::vector<std::vector<std::vector<std::vector<float>>>>;

RowsByScene transposed(const std::vector<std::vector<std::vector<std::vector<double>>>>& rows) {
  RowsByScene all(rows.front().size());
  for (std::size_t s = 0; s < all.size(); ++s) {
    all[s].resize(rows.front()[s].size());
    for (std::size_t u = 0; u < all[s].size(); ++u) {
      all[s][u].assign(rows.front()[s][u].size(), std::vector<float>(rows.size()));
      for (std::size_t i = 0; i < all[s][u].size(); ++i)
        for (std::size_t r = 0; r < rows.size(); ++r) all[s][u][i][r] = static_cast<float>(rows[r][s][u][i]);
    }
  }
  return all;
}

void add_to(std::vector<float>& sums, const std::vector<float>& values, float times) {
  for (std::size_t r = 0; r < sums.size(); ++r) sums[r] += times * values[r];
}

// Adds the mean of one scenario in one resample, so many times, for every row: as crossed_mean() and nested_mean().
void add_resampled(const std::vector<std::vector<std::vector<float>>>& units, bool shared, float times,
                   RandomStream& random, std::vector<float>& sums) {
  shared = shared || units.size() == 1;
  const auto count = static_cast<std::uint32_t>(units.size()), scenes = static_cast<std::uint32_t>(units[0].size());
  const std::uint32_t drawn_units = shared ? count : count - 1;
  const float weight = times / static_cast<float>(drawn_units * scenes);
  std::vector<std::uint32_t> of_all;  // scenes that all drawn units share
  for (std::uint32_t j = 0; shared && j < scenes; ++j) of_all.push_back(random.below(scenes));
  for (std::uint32_t i = 0; i < drawn_units; ++i) {
    const std::vector<std::vector<float>>& unit = units[random.below(count)];
    for (std::uint32_t j = 0; j < scenes; ++j) add_to(sums, unit[shared ? of_all[j] : random.below(scenes)], weight);
  }
}

}  // namespace

void Outcomes::add(const std::string& participant, std::vector<std::string> scenes, std::vector<double> values) {
  policies_.push_back({participant, std::move(scenes), std::move(values)});
}

double Outcomes::Sample::mean() const {
  double sum = 0;
  for (const std::vector<double>& unit : units) sum += statistics::mean(unit);
  return sum / static_cast<double>(units.size());
}

Outcomes::Sample Outcomes::sample() const {
  std::set<std::string> participants;
  for (const PolicyOutcomes& policy : policies_) participants.insert(policy.participant);
  std::map<std::pair<std::string, std::size_t>, ByScene> units;
  for (std::size_t i = 0; i < policies_.size(); ++i) {
    const PolicyOutcomes& policy = policies_[i];
    ByScene& unit = units[{policy.participant, participants.size() > 1 ? 0 : i}];
    for (std::size_t j = 0; j < policy.scenes.size(); ++j) {
      auto& [sum, played] = unit[policy.scenes[j]];
      sum += policy.values[j];
      ++played;
    }
  }
  const ByScene& first = units.begin()->second;
  const auto same_scenes = [&first](const ByScene& unit) {
    return unit.size() == first.size() && std::equal(unit.begin(), unit.end(), first.begin(),
                                                     [](const auto& a, const auto& b) { return a.first == b.first; });
  };
  Sample sample;
  sample.shared = std::all_of(units.begin(), units.end(), [&](const auto& item) { return same_scenes(item.second); });
  std::set<std::string> scenes;
  for (const auto& item : units) {
    std::vector<double>& values = sample.units.emplace_back();
    for (const auto& [scene, outcome] : item.second) {
      values.push_back(outcome.first / outcome.second);
      if (!sample.shared) scenes.insert(scene);
    }
  }
  sample.scenes = static_cast<int>(sample.shared ? first.size() : scenes.size());
  return sample;
}

double mean_outcome(const Samples& scenarios) {
  double sum = 0;
  for (const Outcomes::Sample& sample : scenarios) sum += sample.mean();
  return sum / static_cast<double>(scenarios.size());
}

int distinct_scenes(const Samples& scenarios) {
  int scenes = 0;
  for (const Outcomes::Sample& sample : scenarios) scenes += sample.scenes;
  return scenes;
}

Interval success_interval(const Samples& scenarios, std::string_view name) {
  constexpr int resamples = 2000;
  const int scenes = distinct_scenes(scenarios);
  if (one_policy(scenarios)) return wilson(mean_outcome(scenarios) * scenes, scenes);
  return percentile_interval(resampled_means(scenarios, 0, name, resamples));
}

Change paired_change(const Samples& scenarios, std::string_view name, int resamples) {
  Change change;
  change.difference = mean_outcome(scenarios);
  if (one_policy(scenarios)) {
    const std::vector<double>& values = scenarios.front().units.front();
    const auto only_first = static_cast<int>(std::count(values.begin(), values.end(), -1.0)),
               only_second = static_cast<int>(std::count(values.begin(), values.end(), 1.0));
    change.interval = paired_difference(only_first, only_second, scenarios.front().scenes);
    change.p = mcnemar(only_first, only_second);
    return change;
  }
  const std::vector<double> means = resampled_means(scenarios, -1, name, resamples);
  change.interval = percentile_interval(means);
  change.p = percentile_p(means);
  return change;
}

SharedResamples::SharedResamples(const std::vector<std::vector<std::vector<std::vector<double>>>>& rows, bool shared,
                                 std::string_view name, const std::vector<double>& weights) {
  constexpr std::size_t resamples = 10000;
  const RowsByScene scenarios = transposed(rows);
  for (const auto& units : scenarios)
    scenes_ += static_cast<double>((shared ? 1 : units.size()) * units.front().size());
  RandomStream random(name);
  means_.assign(rows.size(), std::vector<float>(resamples));
  std::vector<float> sums(rows.size());
  for (std::size_t k = 0; k < resamples; ++k) {
    sums.assign(rows.size(), 0);
    float counted = 0;
    for (std::size_t i = 0; i < scenarios.size(); ++i) {
      const float times = weights.empty() ? 1 : static_cast<float>(weights[i]);
      add_resampled(scenarios[i], shared, times, random, sums);
      counted += times;
    }
    for (std::size_t r = 0; r < rows.size(); ++r) means_[r][k] = sums[r] / counted;
    const int one = times_drawn(random), other = times_drawn(random);
    imagined_.emplace_back(one, other);
  }
}

Interval SharedResamples::interval(std::size_t row) const {
  std::vector<double> means;
  for (std::size_t k = 0; k < imagined_.size(); ++k) {
    const auto [one, other] = imagined_[k];
    means.push_back((means_[row][k] * scenes_ + one) / (scenes_ + one + other));
  }
  std::sort(means.begin(), means.end());
  return percentile_interval(means);
}

Interval SharedResamples::difference(std::size_t one, std::size_t other) const {
  std::vector<double> differences;
  for (std::size_t k = 0; k < imagined_.size(); ++k) {
    const auto [less, more] = imagined_[k];
    const double sum = (static_cast<double>(means_[other][k]) - means_[one][k]) * scenes_ + more - less;
    differences.push_back(sum / (scenes_ + less + more));
  }
  std::sort(differences.begin(), differences.end());
  return percentile_interval(differences);
}

std::optional<Interval> SharedResamples::ratio(std::size_t row, std::size_t to) const {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < imagined_.size(); ++k) {
    const auto [one, other] = imagined_[k];
    const double of = means_[row][k] * scenes_ + one, whole = means_[to][k] * scenes_ + other;
    ratios.push_back(whole > 0 ? of / whole : std::numeric_limits<double>::infinity());
  }
  std::sort(ratios.begin(), ratios.end());
  const Interval interval = percentile_interval(ratios);
  return std::isfinite(interval.high) ? std::optional(interval) : std::nullopt;
}

double SharedResamples::p(std::size_t one, std::size_t other) const {
  constexpr double rounding = 1e-6;  // of single precision
  const auto resamples = static_cast<double>(imagined_.size());
  std::size_t up_to_zero = 0, from_zero = 0;
  double total = 0, squares = 0;
  for (std::size_t k = 0; k < imagined_.size(); ++k) {
    const double sum =
        (static_cast<double>(means_[other][k]) - means_[one][k]) * scenes_ + imagined_[k].first - imagined_[k].second;
    up_to_zero += sum <= rounding * scenes_;
    from_zero += sum >= -rounding * scenes_;
    total += sum;
    squares += sum * sum;
  }
  const std::size_t tail = std::min(up_to_zero, from_zero);
  const double counted = std::min(1.0, 2 * (static_cast<double>(tail) + 1) / (resamples + 1));
  if (tail > 0) return counted;
  const double mean = total / resamples, variance = squares / resamples - mean * mean;
  return std::min(counted, std::erfc(std::abs(mean) / std::sqrt(2 * variance)));
}

}  // namespace lgabench::statistics
