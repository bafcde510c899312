// What a learner sees of an observation: smaller pictures (docs/protocol.md, section 5).
#pragma once
#include <cstdint>
#include <vector>

#include <lgabench/core/observation.hpp>

namespace lgabench {

/// The size, in pixels, of the picture that the paper's network sees.
constexpr int input_rows = 36, input_columns = 72, input_pixels = input_rows * input_columns;
constexpr PictureSize input_size{input_rows, input_columns};

/// Writes the area mean of the colours over 255 to `out`, as rows x columns x 3 (red first).
/// @throws InputError if `rgb` is not a picture of size `native`.
void shrink_rgb(const std::vector<std::uint8_t>& rgb, PictureSize native, PictureSize size, float* out);

/// Writes a mask of 0, target_role and second_role (goal_mask.hpp) to `out`, as rows x columns. A small pixel is 1 if
/// any native pixel that it touches is the target's, else -1 if any is to be avoided, else 0. Row r of R touches, of N
/// native rows, floor(N r / R) to ceil(N (r + 1) / R) - 1; columns are alike.
/// @throws InputError if the mask is not of size `native`.
void shrink_mask(const std::vector<std::uint8_t>& mask, PictureSize native, PictureSize size, float* out);

/// Writes ids to `out`, as rows x columns. A small pixel has the id of the native pixel in its middle.
/// @throws InputError if there are not as many as `native` says.
void shrink_ids(const std::vector<std::uint8_t>& ids, PictureSize native, PictureSize size, float* out);

}  // namespace lgabench
