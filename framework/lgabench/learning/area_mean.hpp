// Shrinks a picture by the mean of each area. Private to learning/.
#pragma once
#include <cstdint>

namespace lgabench {

/// Colours over 255: `rgb` of rows x columns x 3 to `out` of small_rows x small_columns x 3, neither larger than the
/// picture. Native pixels on a border count by their parts; the bits are those of OpenCV's resize with INTER_AREA on
/// floats. Takes memory where a thread asks for sizes other than the last ones alone.
void area_mean(const std::uint8_t* rgb, int rows, int columns, int small_rows, int small_columns, float* out);

}  // namespace lgabench
