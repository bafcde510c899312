// What a learner sees of an observation: smaller pictures (docs/protocol.md, section 5).
#pragma once
#include <cstdint>
#include <vector>

#include <lgabench/core/observation.hpp>

namespace lgabench {

/// Rows along x, columns along y.
struct PictureSize {
  int rows, columns;
};
inline bool operator==(PictureSize a, PictureSize b) { return a.rows == b.rows && a.columns == b.columns; }

constexpr PictureSize native_size{Observation::rows, Observation::columns};
/// The paper's.
constexpr int input_rows = 36, input_columns = 72, input_pixels = input_rows * input_columns;
constexpr PictureSize input_size{input_rows, input_columns};

/// Area mean of the colours over 255, written to `out` as rows x columns x 3 (red first).
/// @throws InputError if the picture is not 128 x 256 x 3.
void shrink_rgb(const std::vector<std::uint8_t>& rgb, PictureSize size, float* out);

/// A mask of 0, target_role and avoid_role (goal_mask.hpp), written to `out` as rows x columns: 1 where any native
/// pixel that the small one touches is the target's, else -1 where any is to be avoided, else 0. Row r of R touches
/// native rows floor(128 r / R) to ceil(128 (r + 1) / R) - 1, columns alike.
/// @throws InputError if the mask is not 128 x 256.
void shrink_mask(const std::vector<std::uint8_t>& mask, PictureSize size, float* out);

}  // namespace lgabench
