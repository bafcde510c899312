#include <axes/pixels.hpp>

#include <algorithm>
#include <cmath>

namespace lgabench::perturbations {
namespace {

void on_one_thread() {
  [[maybe_unused]] static const bool once = (cv::setNumThreads(0), true);  // other cells have the other cores
}

}  // namespace

cv::Mat rgb_of(Observation& seen) {
  on_one_thread();
  return {seen.size.rows, seen.size.columns, CV_8UC3, seen.rgb.data()};
}

cv::Mat ids_of(Observation& seen) {
  on_one_thread();
  return {seen.size.rows, seen.size.columns, CV_8UC1, seen.ids.data()};
}

void multiply(Observation& seen, const std::array<double, 3>& factors) {
  for (std::size_t i = 0; i < seen.rgb.size(); ++i) seen.rgb[i] = to_byte(seen.rgb[i] * factors[i % 3]);
}

std::uint8_t to_byte(double value) { return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0., 255.))); }

}  // namespace lgabench::perturbations
