#include <lgabench/learning/inputs.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

constexpr int rows = Observation::rows, columns = Observation::columns;

void expect_size(const char* what, std::size_t size, std::size_t expected) {
  if (size != expected)
    throw InputError(fmt::format("observation: {}: expected {} values, got {}", what, expected, size));
}

// The share that a native row or column has in the mean that a small one is.
struct Share {
  int small, native;
  float weight;
};

// By small and native index; rounded as OpenCV's resize with INTER_AREA does, for the same bits.
std::vector<Share> shares(int native, int small) {
  constexpr double negligible = 1e-3;
  const double scale = 1 / (static_cast<double>(small) / native);
  std::vector<Share> all;
  for (int i = 0; i < small; ++i) {
    const double begin = i * scale, end = begin + scale, width = std::min(scale, native - begin);
    const int last = std::min(static_cast<int>(std::floor(end)), native - 1);
    const int first = std::min(static_cast<int>(std::ceil(begin)), last);
    const auto add = [&](int index, double part) { all.push_back({i, index, static_cast<float>(part / width)}); };
    if (first - begin > negligible) add(first - 1, first - begin);
    for (int whole = first; whole < last; ++whole) add(whole, 1);
    if (end - last > negligible) add(last, std::min({end - last, 1., width}));
  }
  return all;
}

std::array<float, 256> levels() {
  std::array<float, 256> all{};
  for (std::size_t byte = 0; byte < all.size(); ++byte)
    all[byte] = static_cast<float>(byte) * static_cast<float>(1 / 255.0);
  return all;
}

}  // namespace

void shrink_rgb(const std::vector<std::uint8_t>& rgb, float* out) {
  expect_size("rgb", rgb.size(), std::size_t{rows} * columns * 3);
  static const std::vector<Share> down = shares(rows, input_rows), across = shares(columns, input_columns);
  static const std::array<float, 256> level = levels();
  constexpr int width = 3 * input_columns;
  std::array<float, width> line{};  // a native row, its columns shrunk
  std::fill(out, out + input_rows * width, 0.f);
  int in_line = -1;
  for (const Share& row : down) {
    if (std::exchange(in_line, row.native) != row.native) {  // else it has a part in the small row above too
      const std::uint8_t* const from = rgb.data() + std::ptrdiff_t{row.native} * columns * 3;
      line.fill(0);
      for (const Share& column : across)
        for (int c = 0; c < 3; ++c) line[3 * column.small + c] += level[from[3 * column.native + c]] * column.weight;
    }
    float* const to = out + row.small * width;
    for (int i = 0; i < width; ++i) to[i] += line[i] * row.weight;
  }
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
