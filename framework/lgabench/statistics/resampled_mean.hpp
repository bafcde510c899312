// The mean of a scenario whose scenes and policies are drawn again, by few random numbers.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <lgabench/core/random.hpp>
#include <lgabench/statistics/bootstrap.hpp>

namespace lgabench::statistics {

/// The sum of n draws with replacement from n whole numbers, by one random number: the inverse of the sum's
/// distribution function.
class ResampledSum {
 public:
  /// Takes n^2 / 2 span (span + 1) additions for n values that differ by up to `span`. @pre not empty
  explicit ResampledSum(const std::vector<int>& values);
  int draw(RandomStream& random) const;

 private:
  int lowest_;
  std::vector<double> up_to_;       // [i]: probability of at most lowest_ + i; the last is 1
  std::vector<std::size_t> guide_;  // [g]: the first i with up_to_[i] above g / size (Chen and Asau 1974)
};

/// A scenario's mean in a resample, crossed or nested as bootstrap.hpp says: for outcomes that are whole numbers, the
/// distribution of drawing scene by scene. One thread; the sample must outlive the object.
class ResampledMean {
 public:
  /// Whether outcomes are whole numbers, and the sums' distributions cost less than drawing so many resamples.
  static bool pays(const Outcomes::Sample& sample, int resamples);
  /// @pre pays() for some number of resamples
  explicit ResampledMean(const Outcomes::Sample& sample);
  double draw(RandomStream& random);

 private:
  double crossed(RandomStream& random);
  double nested(RandomStream& random);

  const Outcomes::Sample* sample_;
  std::vector<std::optional<ResampledSum>> sums_;  // nested: of each unit; crossed: of units drawn together, once drawn
  std::vector<std::uint32_t> drawn_;
};

}  // namespace lgabench::statistics
