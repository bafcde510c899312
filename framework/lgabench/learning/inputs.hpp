// What a network sees of an observation: pictures of 36 x 72 (docs/protocol.md, section 5).
#pragma once
#include <cstdint>
#include <vector>

#include <lgabench/core/observation.hpp>

namespace lgabench {

constexpr int input_rows = 36, input_columns = 72, input_pixels = input_rows * input_columns;

/// Area mean of the colours over 255, written to `out` as 36 x 72 x 3 (red first).
/// @throws InputError if the picture is not 128 x 256 x 3.
void shrink_rgb(const std::vector<std::uint8_t>& rgb, float* out);

/// 1 where any native pixel that the small one touches is not 0, else 0; written to `out` as 36 x 72. Row r touches
/// native rows floor(128 r / 36) to ceil(128 (r + 1) / 36) - 1, columns alike.
/// @throws InputError if the mask is not 128 x 256.
void shrink_mask(const std::vector<std::uint8_t>& mask, float* out);

}  // namespace lgabench
