#include <lgabench/statistics/resampled_mean.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace lgabench::statistics {
namespace {

constexpr std::size_t most_units = 4;
constexpr std::array<int, most_units + 1> multisets{0, 1, 3, 10, 35};  // of as many units as there are

}  // namespace

ResampledSum::ResampledSum(const std::vector<int>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  lowest_ = *low * static_cast<int>(values.size());
  std::vector<double> one(static_cast<std::size_t>(*high - *low) + 1), next;
  for (const int value : values) one[static_cast<std::size_t>(value - *low)] += 1 / static_cast<double>(values.size());
  up_to_ = {1};
  for (std::size_t draw = 0; draw < values.size(); ++draw) {
    next.assign(up_to_.size() + one.size() - 1, 0);
    for (std::size_t k = 0; k < one.size(); ++k)
      for (std::size_t i = 0; i < up_to_.size(); ++i) next[i + k] += up_to_[i] * one[k];
    up_to_.swap(next);
  }
  std::partial_sum(up_to_.begin(), up_to_.end(), up_to_.begin());
  up_to_.back() = 1;  // rounding may miss it
  constexpr std::size_t guides = 256;
  for (std::size_t g = 0, i = 0; g < guides; ++g) {
    while (up_to_[i] <= static_cast<double>(g) / guides) ++i;
    guide_.push_back(i);
  }
}

int ResampledSum::draw(RandomStream& random) const {
  const double u = random.uniform();
  std::size_t i = guide_[static_cast<std::size_t>(u * static_cast<double>(guide_.size()))];
  while (up_to_[i] <= u) ++i;
  return lowest_ + static_cast<int>(i);
}

bool ResampledMean::pays(const Outcomes::Sample& sample, int resamples) {
  if (sample.units.size() > most_units) return false;
  double low = 0, high = 0;
  std::size_t scenes = 0;
  for (const std::vector<double>& unit : sample.units) {
    scenes = std::max(scenes, unit.size());
    for (const double value : unit) {
      if (value != std::trunc(value)) return false;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  constexpr double additions_per_draw = 4;  // measured, roughly
  const double sums = sample.shared ? multisets[sample.units.size()] : 1,
               span = (high - low) * (sample.shared ? static_cast<double>(sample.units.size()) : 1);
  return sums * static_cast<double>(scenes) / 2 * span * (span + 1) < additions_per_draw * resamples;
}

ResampledMean::ResampledMean(const Outcomes::Sample& sample) : sample_(&sample) {
  if (!sample.shared)
    for (const std::vector<double>& unit : sample.units) sums_.emplace_back(std::vector<int>(unit.begin(), unit.end()));
  else
    sums_.resize(static_cast<std::size_t>(std::pow(sample.units.size(), sample.units.size())));
}

double ResampledMean::draw(RandomStream& random) { return sample_->shared ? crossed(random) : nested(random); }

double ResampledMean::crossed(RandomStream& random) {
  const std::size_t units = sample_->units.size(), scenes = sample_->units[0].size();
  drawn_.resize(units);
  for (std::uint32_t& unit : drawn_) unit = random.below(static_cast<std::uint32_t>(units));
  std::sort(drawn_.begin(), drawn_.end());
  std::size_t place = 0;
  for (const std::uint32_t unit : drawn_) place = place * units + unit;
  if (!sums_[place]) {
    std::vector<int> values(scenes);
    for (const std::uint32_t unit : drawn_)
      for (std::size_t j = 0; j < scenes; ++j) values[j] += static_cast<int>(sample_->units[unit][j]);
    sums_[place].emplace(values);
  }
  return sums_[place]->draw(random) / static_cast<double>(units * scenes);
}

double ResampledMean::nested(RandomStream& random) {
  const std::size_t units = sample_->units.size();
  double sum = 0;
  for (std::size_t i = 1; i < units; ++i) {
    const std::uint32_t unit = random.below(static_cast<std::uint32_t>(units));
    sum += sums_[unit]->draw(random) / static_cast<double>(sample_->units[unit].size());
  }
  return sum / static_cast<double>(units - 1);
}

}  // namespace lgabench::statistics
