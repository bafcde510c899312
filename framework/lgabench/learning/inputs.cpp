#include <lgabench/learning/inputs.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

void expect_size(const char* what, std::size_t size, std::size_t expected) {
  if (size != expected)
    throw InputError(fmt::format("observation: {}: expected {} values, got {}", what, expected, size));
}

}  // namespace

void shrink_rgb(const std::vector<std::uint8_t>& rgb, PictureSize native, PictureSize size, float* out) {
  // A small picture gains nothing by OpenCV's pool of threads, and other cells have the other cores.
  [[maybe_unused]] static const bool one_thread = (cv::setNumThreads(0), true);
  expect_size("rgb", rgb.size(), native.pixels() * 3);
  // In floating point: OpenCV would round the means of bytes to bytes.
  cv::Mat shares, small(size.rows, size.columns, CV_32FC3, out);
  cv::Mat(native.rows, native.columns, CV_8UC3, const_cast<std::uint8_t*>(rgb.data()))
      .convertTo(shares, CV_32FC3, 1 / 255.0);
  cv::resize(shares, small, cv::Size(size.columns, size.rows), 0, 0, cv::INTER_AREA);
}

void shrink_mask(const std::vector<std::uint8_t>& mask, PictureSize native, PictureSize size, float* out) {
  expect_size("mask", mask.size(), native.pixels());
  const auto first = [](int small, int of, int count) { return of * small / count; };
  const auto last = [](int small, int of, int count) { return (of * (small + 1) + count - 1) / count; };
  for (int r = 0; r < size.rows; ++r)
    for (int c = 0; c < size.columns; ++c) {
      const int left = first(c, native.columns, size.columns), right = last(c, native.columns, size.columns);
      bool target = false, second = false;
      for (int y = first(r, native.rows, size.rows); y < last(r, native.rows, size.rows); ++y)
        for (int x = left; x < right; ++x) {
          const std::uint8_t role = mask[static_cast<std::size_t>(y * native.columns + x)];
          target = target || role == target_role;
          second = second || role == second_role;
        }
      *out++ = target ? 1.f : second ? -1.f : 0.f;
    }
}

void shrink_ids(const std::vector<std::uint8_t>& ids, PictureSize native, PictureSize size, float* out) {
  expect_size("ids", ids.size(), native.pixels());
  for (int r = 0; r < size.rows; ++r)
    for (int c = 0; c < size.columns; ++c)
      *out++ = ids[static_cast<std::size_t>((2 * r + 1) * native.rows / (2 * size.rows) * native.columns +
                                            (2 * c + 1) * native.columns / (2 * size.columns))];
}

}  // namespace lgabench
