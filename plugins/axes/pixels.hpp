// What axes do to pictures, with OpenCV on one thread.
#pragma once
#include <array>
#include <cstdint>

#include <lgabench/core/observation.hpp>

#include <opencv2/core.hpp>

namespace lgabench::perturbations {

/// rows x columns x 3, RGB, and rows x columns; they share the observation's memory.
cv::Mat rgb_of(Observation& seen);
cv::Mat ids_of(Observation& seen);

/// Each channel times its factor, rounded; what is brighter than white is white.
void multiply(Observation& seen, const std::array<double, 3>& factors);

/// A length in pixels of a picture of 256 columns, in this one's.
inline double in_pixels(const Observation& seen, double of_256) { return of_256 * seen.size.columns / 256; }

/// Rounded, within 0 to 255.
std::uint8_t to_byte(double value);

}  // namespace lgabench::perturbations
