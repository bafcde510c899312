#include <lgabench/learning/noisy_copies.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <lgabench/core/action.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench {
namespace {

// Of all n values, as numpy.std.
double deviation(const float* values, std::size_t n) {
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < n; ++i) sum += values[i];
  const double mean = sum / static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) squares += (values[i] - mean) * (values[i] - mean);
  return std::sqrt(squares / static_cast<double>(n));
}

void add_noise(float* values, std::size_t n, double scale, RandomStream& random) {
  const double sigma = scale * deviation(values, n);
  for (std::size_t i = 0; i < n; ++i) values[i] += static_cast<float>(sigma * random.gaussian());
}

}  // namespace

Samples with_noisy_copies(const Samples& clean, int copies, double scale, std::uint64_t seed) {
  Samples all(clean.shape, clean.rows * (1 + copies));
  for (int row = 0; row < clean.rows; ++row)
    for (int copy = 0; copy <= copies; ++copy) {  // the first is the original
      RandomStream random(fmt::format("dart/posthoc/{}/{}/{}", seed, row, copy));
      const auto put = [&](const std::vector<float>& from, std::vector<float>& to, bool noisy) {
        const std::size_t n = from.size() / static_cast<std::size_t>(clean.rows);
        float* const out = to.data() + static_cast<std::size_t>(row * (1 + copies) + copy) * n;
        std::copy_n(from.data() + static_cast<std::size_t>(row) * n, n, out);
        if (noisy && copy > 0) add_noise(out, n, scale, random);
      };
      put(clean.labels, all.labels, true);
      for (std::size_t i = 0; i < clean.pictures.size(); ++i) put(clean.pictures[i], all.pictures[i], true);
      if (clean.shape.text) put(clean.text, all.text, false);
    }
  return all;
}

}  // namespace lgabench
