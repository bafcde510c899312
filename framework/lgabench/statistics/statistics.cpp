#include <lgabench/statistics/statistics.hpp>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <iterator>
#include <numeric>

namespace lgabench::statistics {
namespace {

constexpr double z = z_95;

// Probability that, of the ranks 1..n with random signs, the positive ones sum to `sum` at most.
double signed_rank_tail(std::size_t n, std::size_t sum) {
  std::vector<double> ways(n * (n + 1) / 2 + 1);  // whole numbers up to 2^25
  ways[0] = 1;
  for (std::size_t rank = 1; rank <= n; ++rank)
    for (std::size_t s = ways.size(); s-- > rank;) ways[s] += ways[s - rank];
  return std::accumulate(ways.begin(), ways.begin() + static_cast<std::ptrdiff_t>(sum) + 1, 0.0) /
         std::pow(2.0, static_cast<double>(n));
}

// Student's t test of a mean that is 0 but for its standard error.
Change student(double m, double error, double freedom) {
  if (error == 0) return {m, {m, m}, m == 0 ? 1.0 : 0.0};
  const boost::math::students_t t(freedom);
  const double half = boost::math::quantile(t, 0.975) * error;
  return {m, {m - half, m + half}, 2 * boost::math::cdf(boost::math::complement(t, std::abs(m) / error))};
}

}  // namespace

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

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

std::vector<double> holm(const std::vector<double>& p) {
  std::vector<std::size_t> ascending(p.size());
  std::iota(ascending.begin(), ascending.end(), 0);
  std::sort(ascending.begin(), ascending.end(), [&p](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double largest = 0;  // so far: one that is refused later cannot have a smaller value
  for (std::size_t i = 0; i < p.size(); ++i) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(p.size() - i) * p[ascending[i]]));
    adjusted[ascending[i]] = largest;
  }
  return adjusted;
}

double wilcoxon(const std::vector<double>& differences) {
  std::vector<double> d;
  std::copy_if(differences.begin(), differences.end(), std::back_inserter(d), [](double x) { return x != 0; });
  if (d.empty()) return 1;
  std::sort(d.begin(), d.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  const auto n = static_cast<double>(d.size());
  double positive = 0, ties = 0;  // sum of their ranks; sum of t^3 - t over groups of t equals
  for (std::size_t begin = 0, end; begin < d.size(); begin = end) {
    for (end = begin + 1; end < d.size() && std::abs(d[end]) == std::abs(d[begin]);) ++end;
    const auto t = static_cast<double>(end - begin);
    ties += t * t * t - t;
    for (std::size_t i = begin; i < end; ++i)
      if (d[i] > 0) positive += static_cast<double>(begin + end + 1) / 2;  // the mean of the ranks begin+1..end
  }
  const double all = n * (n + 1) / 2;
  constexpr std::size_t exact_up_to = 25;
  if (d.size() <= exact_up_to && ties == 0)
    return std::min(1.0, 2 * signed_rank_tail(d.size(), static_cast<std::size_t>(std::min(positive, all - positive))));
  const double off = std::max(0.0, std::abs(positive - all / 2) - 0.5);
  const double deviation = std::sqrt(n * (n + 1) * (2 * n + 1) / 24 - ties / 48);
  return 2 * boost::math::cdf(boost::math::complement(boost::math::normal(), off / deviation));
}

std::vector<double> slope_weights(const std::vector<double>& at) {
  const double middle = mean(at);
  double squares = 0;
  for (const double x : at) squares += (x - middle) * (x - middle);
  std::vector<double> weights;
  for (const double x : at) weights.push_back((x - middle) / squares);
  return weights;
}

Spread spread(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double m = mean(values);
  double squares = 0;
  for (const double value : values) squares += (value - m) * (value - m);
  if (values.size() < 2) return {m, {}, {}};
  const double sd = std::sqrt(squares / (n - 1));
  return {m, sd, sd / std::sqrt(n)};
}

Change paired_t(const std::vector<double>& differences) {
  const Spread all = spread(differences);
  return student(all.mean, *all.se, static_cast<double>(differences.size()) - 1);
}

std::optional<Interval> over_clusters(const std::vector<double>& values, const std::vector<double>& weights,
                                      const Interval& within) {
  if (values.size() < least_clusters) return {};
  const auto n = static_cast<double>(values.size());
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  const double m = std::inner_product(values.begin(), values.end(), weights.begin(), 0.0) / total;
  double squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) squares += std::pow(weights[i] / total * (values[i] - m), 2);
  const Interval between = student(m, std::sqrt(squares * n / (n - 1)), n - 1).interval;
  return Interval{std::min(between.low, within.low), std::max(between.high, within.high)};
}

Change welch_t(const std::vector<double>& first, const std::vector<double>& second) {
  const Spread a = spread(first), b = spread(second);
  const double va = *a.se * *a.se, vb = *b.se * *b.se, both = va + vb;
  const double freedom = both == 0 ? 1
                                   : both * both /
                                         (va * va / (static_cast<double>(first.size()) - 1) +
                                          vb * vb / (static_cast<double>(second.size()) - 1));
  return student(a.mean - b.mean, std::sqrt(both), freedom);
}

std::vector<Change> least_squares(const std::vector<std::vector<double>>& rows, const std::vector<double>& values) {
  const std::size_t n = rows.size(), p = n == 0 ? 0 : rows.front().size();
  if (n <= p || p == 0) return {};
  std::vector<std::vector<double>> square(p, std::vector<double>(p)), inverse = square;
  for (std::size_t i = 0; i < p; ++i) {
    inverse[i][i] = 1;
    for (std::size_t j = 0; j < p; ++j)
      for (const auto& row : rows) square[i][j] += row[i] * row[j];
  }
  for (std::size_t i = 0; i < p; ++i) {  // Gauss and Jordan, by the largest pivot
    std::size_t pivot = i;
    for (std::size_t j = i; j < p; ++j)
      if (std::abs(square[j][i]) > std::abs(square[pivot][i])) pivot = j;
    if (std::abs(square[pivot][i]) < 1e-9 * static_cast<double>(n)) return {};
    std::swap(square[i], square[pivot]), std::swap(inverse[i], inverse[pivot]);
    for (std::size_t j = 0; j < p; ++j) {
      const double by = square[j][i] / square[i][i];
      for (std::size_t k = 0; k < p && j != i; ++k) {
        square[j][k] -= by * square[i][k];
        inverse[j][k] -= by * inverse[i][k];
      }
    }
    const double by = square[i][i];
    for (std::size_t k = 0; k < p; ++k) {
      square[i][k] /= by;
      inverse[i][k] /= by;
    }
  }
  std::vector<double> coefficients(p);
  for (std::size_t i = 0; i < p; ++i)
    for (std::size_t r = 0; r < n; ++r)
      coefficients[i] += values[r] * std::inner_product(rows[r].begin(), rows[r].end(), inverse[i].begin(), 0.0);
  double squares = 0;
  for (std::size_t r = 0; r < n; ++r) {
    const double off = values[r] - std::inner_product(rows[r].begin(), rows[r].end(), coefficients.begin(), 0.0);
    squares += off * off;
  }
  const auto freedom = static_cast<double>(n - p);
  std::vector<Change> all;
  for (std::size_t i = 0; i < p; ++i)
    all.push_back(student(coefficients[i], std::sqrt(squares / freedom * inverse[i][i]), freedom));
  return all;
}

}  // namespace lgabench::statistics
