#include <lgabench/learning/noisy_copies.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <lgabench/core/action.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench {
namespace {

// Standard deviation of all n values, as numpy.std.
double deviation(const float* values, std::size_t n) {
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < n; ++i) sum += values[i];
  const double mean = sum / static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) squares += (values[i] - mean) * (values[i] - mean);
  return std::sqrt(squares / static_cast<double>(n));
}

// Sigma of value number i.
template <typename Sigma>
void add_noise(float* values, std::size_t n, const Sigma& sigma, RandomStream& random) {
  for (std::size_t i = 0; i < n; ++i) values[i] += static_cast<float>(sigma(i) * random.gaussian());
}

}  // namespace

Samples with_noisy_copies(const Samples& clean, int copies, double scale, std::uint64_t seed, CopyNoise of) {
  Samples all(clean.shape, clean.rows * (1 + copies));
  for (int row = 0; row < clean.rows; ++row)
    for (int copy = 0; copy <= copies; ++copy) {  // the first is the original
      RandomStream random(fmt::format("dart/posthoc/{}/{}/{}", seed, row, copy));
      // `range` of value number i, for CopyNoise::ranges.
      const auto put = [&](const std::vector<float>& from, std::vector<float>& to, const auto& range) {
        const std::size_t n = from.size() / static_cast<std::size_t>(clean.rows);
        float* const out = to.data() + static_cast<std::size_t>(row * (1 + copies) + copy) * n;
        std::copy_n(from.data() + static_cast<std::size_t>(row) * n, n, out);
        if (copy == 0) return;
        const double sigma = of == CopyNoise::deviations ? scale * deviation(out, n) : 0;
        add_noise(
            out, n, [&](std::size_t i) { return of == CopyNoise::deviations ? sigma : scale * range(i); }, random);
      };
      put(clean.labels, all.labels, [&](std::size_t i) {
        const ActionNumber& number = clean.shape.actions.numbers[i];
        return number.high - number.low;
      });
      for (std::size_t i = 0; i < clean.pictures.size(); ++i)
        put(clean.pictures[i], all.pictures[i], [](std::size_t) { return 1.; });
      const auto keep = [&](const std::vector<float>& from, std::vector<float>& to, std::size_t numbers) {
        const auto n = static_cast<std::ptrdiff_t>(numbers);
        std::copy_n(from.begin() + row * n, n, to.begin() + (row * (1 + copies) + copy) * n);
      };
      if (clean.shape.text) keep(clean.text, all.text, text_size);
      keep(clean.state, all.state, clean.shape.state.size());
    }
  all.stops = clean.stops;
  return all;
}

}  // namespace lgabench
