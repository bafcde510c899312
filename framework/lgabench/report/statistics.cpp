#include <lgabench/report/statistics.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <lgabench/core/random.hpp>

namespace lgabench::report {
namespace {

constexpr double z = 1.959963984540054;  // standard normal quantile at .975

// `chance`, what the episodes alone leave open; with several policies nowhere narrower than their bootstrap.
Interval widened(const Interval& chance, const std::vector<Cluster>& clusters, std::string_view name) {
  if (clusters.size() == 1 && clusters.front().size() == 1) return chance;
  const Interval between = cluster_bootstrap(clusters, name);
  return {std::min(chance.low, between.low), std::max(chance.high, between.high)};
}

double mean(const Cluster& rates) {
  return std::accumulate(rates.begin(), rates.end(), 0.0) / static_cast<double>(rates.size());
}

}  // namespace

Interval wilson(double successes, int episodes) {
  const double n = episodes, p = successes / n;
  const double centre = p + z * z / (2 * n), half = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  const double scale = 1 / (1 + z * z / n);
  // At the ends the formula gives exactly 0 and 1, but for rounding.
  return {successes == 0 ? 0 : (centre - half) * scale, successes == episodes ? 1 : (centre + half) * scale};
}

double mcnemar(int only_first, int only_second) {
  const int n = only_first + only_second, fewer = std::min(only_first, only_second);
  // Binomial(n, 1/2) up to `fewer`, each term from the last; in logarithms, as 2^-n underflows for large n.
  double log_term = -n * std::log(2.0), tail = 0;
  for (int k = 0; k <= fewer; ++k) {
    tail += std::exp(log_term);
    log_term += std::log(static_cast<double>(n - k)) - std::log(k + 1.0);
  }
  return std::min(1.0, 2 * tail);
}

Interval paired_difference(int only_first, int only_second, int episodes) {
  const double n = episodes + 2.0, first = (only_first + 1) / n, second = (only_second + 1) / n;
  const double centre = second - first, half = z * std::sqrt((first + second - centre * centre) / n);
  return {std::max(-1.0, centre - half), std::min(1.0, centre + half)};
}

double cluster_mean(const std::vector<Cluster>& clusters) {
  double sum = 0;
  for (const Cluster& rates : clusters) sum += mean(rates);
  return sum / static_cast<double>(clusters.size());
}

Interval cluster_bootstrap(const std::vector<Cluster>& clusters, std::string_view name) {
  constexpr std::size_t resamples = 10000, cut = resamples / 40;  // 2.5 % on either side
  RandomStream random(name);
  std::vector<double> means(resamples);
  for (double& resampled : means) {
    double sum = 0;
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      const Cluster& rates = clusters[random.below(static_cast<std::uint32_t>(clusters.size()))];
      const auto n = static_cast<std::uint32_t>(rates.size());
      double within = 0;
      for (std::uint32_t j = 0; j < n; ++j) within += rates[random.below(n)];
      sum += within / n;
    }
    resampled = sum / static_cast<double>(clusters.size());
  }
  std::sort(means.begin(), means.end());
  return {means[cut], means[resamples - 1 - cut]};
}

Interval success_interval(const std::vector<Cluster>& clusters, int episodes, std::string_view name) {
  return widened(wilson(cluster_mean(clusters) * episodes, episodes), clusters, name);
}

Interval change_interval(const std::vector<Cluster>& differences, int only_first, int only_second, int episodes,
                         std::string_view name) {
  return widened(paired_difference(only_first, only_second, episodes), differences, name);
}

}  // namespace lgabench::report
