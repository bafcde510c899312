#include <lgabench/learning/inputs.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/error.hpp>
#include <lgabench/learning/area_mean.hpp>

namespace lgabench {
namespace {

constexpr int rows = Observation::rows, columns = Observation::columns;

void expect_size(const char* what, std::size_t size, std::size_t expected) {
  if (size != expected)
    throw InputError(fmt::format("observation: {}: expected {} values, got {}", what, expected, size));
}

}  // namespace

void shrink_rgb(const std::vector<std::uint8_t>& rgb, float* out) {
  expect_size("rgb", rgb.size(), std::size_t{rows} * columns * 3);
  area_mean(rgb.data(), rows, columns, input_rows, input_columns, out);
}

void shrink_mask(const std::vector<std::uint8_t>& mask, float* out) {
  expect_size("mask", mask.size(), std::size_t{rows} * columns);
  const auto first = [](int small, int native, int count) { return native * small / count; };
  const auto last = [](int small, int native, int count) { return (native * (small + 1) + count - 1) / count; };
  for (int r = 0; r < input_rows; ++r)
    for (int c = 0; c < input_columns; ++c) {
      const int left = first(c, columns, input_columns), right = last(c, columns, input_columns);
      bool any = false;
      for (int y = first(r, rows, input_rows); y < last(r, rows, input_rows); ++y) {
        const auto row = mask.begin() + y * columns;
        any = any || std::any_of(row + left, row + right, [](std::uint8_t value) { return value != 0; });
      }
      *out++ = any ? 1.0f : 0.0f;
    }
}

}  // namespace lgabench
