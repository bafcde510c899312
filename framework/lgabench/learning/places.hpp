// Points of the table in a signed mask (shrink_mask()) of native size: > 0 on the target, < 0 on what is to be avoided.
// Private to learning/.
#pragma once
#include <optional>
#include <vector>

#include <lgabench/core/geometry.hpp>
#include <lgabench/learning/inputs.hpp>

namespace lgabench {

/// The middle of a pixel of the picture of the table.
Vec2 middle_of(PictureSize size, int row, int column);

bool on_target(const float* mask, Vec2 point);
/// The point if its pixel is the target's with two more on every side, else the middle of the nearest that is; of all
/// target pixels where none is. The point where there is no target.
Vec2 onto_target(const float* mask, Vec2 point);
/// Centroid of what is to be avoided.
std::optional<Vec2> avoided_in(const float* mask);

/// Finds a point to take hold of. Buffers are kept: looking allocates nothing.
class Eye {
 public:
  Eye();
  /// The centroid of one connected piece of the target, onto_target() of that piece: of the piece nearest to `pose0`,
  /// of the largest where that is null. None without a target.
  std::optional<Vec2> taken(const float* mask, const Vec2* pose0);

 private:
  struct Piece;
  Piece fill(const float* mask, int pixel, int id, const Vec2* pose0);

  std::vector<int> piece_of_;  // pixel -> 1, 2, ... in reading order; 0 off the target
  std::vector<int> pending_;
  std::vector<float> alone_;  // the mask of one piece
};

}  // namespace lgabench
