#include <lgabench/learning/area_mean.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

namespace lgabench {
namespace {

// The share that a native row or column has in the mean that a small one is.
struct Share {
  int small, native;
  float weight;
};

// By small and native index, rounded as OpenCV does.
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

struct Tables {
  std::tuple<int, int, int, int> sizes;
  std::vector<Share> down, across;
  std::vector<float> line;  // a native row, its columns shrunk
};

Tables& tables_for(int rows, int columns, int small_rows, int small_columns) {
  thread_local Tables last;
  const std::tuple wanted(rows, columns, small_rows, small_columns);
  if (last.sizes != wanted)
    last = {wanted, shares(rows, small_rows), shares(columns, small_columns),
            std::vector<float>(static_cast<std::size_t>(3 * small_columns))};
  return last;
}

constexpr std::array<float, 256> levels() {
  std::array<float, 256> all{};
  for (int byte = 0; byte < 256; ++byte)
    all[static_cast<std::size_t>(byte)] = static_cast<float>(byte) * static_cast<float>(1 / 255.0);
  return all;
}

}  // namespace

void area_mean(const std::uint8_t* rgb, int rows, int columns, int small_rows, int small_columns, float* out) {
  constexpr std::array<float, 256> level = levels();
  auto& [sizes, down, across, line] = tables_for(rows, columns, small_rows, small_columns);
  const int width = 3 * small_columns;
  float* const sums = line.data();
  std::fill(out, out + small_rows * width, 0.f);
  int in_line = -1;
  for (const Share& row : down) {
    if (std::exchange(in_line, row.native) != row.native) {  // else it has a part in the small row above too
      const std::uint8_t* const from = rgb + std::ptrdiff_t{row.native} * columns * 3;
      std::fill(sums, sums + width, 0.f);
      for (const Share& column : across)
        for (int c = 0; c < 3; ++c) sums[3 * column.small + c] += level[from[3 * column.native + c]] * column.weight;
    }
    float* const to = out + row.small * width;
    for (int i = 0; i < width; ++i) to[i] += sums[i] * row.weight;
  }
}

}  // namespace lgabench
