// Rows that networks are trained on in tests.
#pragma once
#include <cstddef>
#include <numeric>
#include <vector>

#include <lgabench/core/random.hpp>
#include <lgabench/learning/network_shape.hpp>
#include <lgabench/learning/samples.hpp>

namespace lgabench {

// Of four masks one is random everywhere, two within a rectangle, and one is empty; colours are random everywhere, and
// masks too before batch normalisation, which would enlarge the rounding of what is nearly the same everywhere.
inline Samples random_samples(const NetworkShape& shape, int rows) {
  RandomStream random("samples");
  Samples s(shape.samples(), rows);
  for (auto& picture : s.pictures)
    for (float& value : picture) value = static_cast<float>(random.uniform());
  for (std::size_t t = 0; t < shape.channels.size(); ++t)
    for (int row = 0; row < rows && shape.channels[t] == 1 && shape.architecture == Architecture::plain; ++row) {
      const int top = static_cast<int>(random.below(30)), left = static_cast<int>(random.below(60));
      for (int pixel = 0; pixel < input_pixels && row % 4 != 0; ++pixel) {
        const int y = pixel / input_columns - top, x = pixel % input_columns - left;
        if (row % 4 == 3 || y < 0 || y > 8 || x < 0 || x > 11)
          s.pictures[t][static_cast<std::size_t>(row * input_pixels + pixel)] = 0;
      }
    }
  for (float& value : s.text) value = static_cast<float>(random.gaussian() / 20);
  for (float& value : s.labels) value = static_cast<float>(random.uniform());
  return s;
}

// As those, with every picture but for a rectangle like the first.
inline Samples mostly_alike(const NetworkShape& shape, int rows) {
  RandomStream random("alike");
  Samples s = random_samples(shape, rows);
  for (std::size_t t = 0; t < shape.channels.size(); ++t) {
    const std::size_t numbers = s.pictures[t].size() / static_cast<std::size_t>(rows),
                      channels = numbers / input_pixels;
    for (int row = 1; row < rows; ++row) {
      const int top = static_cast<int>(random.below(20)), left = static_cast<int>(random.below(50));
      for (std::size_t i = 0; i < numbers; ++i) {
        const int y = static_cast<int>(i / channels) / input_columns - top,
                  x = static_cast<int>(i / channels) % input_columns - left;
        if (y < 0 || y > 14 || x < 0 || x > 20)
          s.pictures[t][static_cast<std::size_t>(row) * numbers + i] = s.pictures[t][i];
      }
    }
  }
  return s;
}

inline std::vector<int> all_rows(const Samples& samples) {
  std::vector<int> rows(static_cast<std::size_t>(samples.rows));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

}  // namespace lgabench
