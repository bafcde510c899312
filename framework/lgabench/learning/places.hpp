// Places in a picture as numbers of an action, and what a signed mask (shrink_mask()) shows there. Private to
// learning/.
#pragma once
#include <optional>
#include <vector>

#include <lgabench/core/action.hpp>

namespace lgabench {

/// What a picture shows: x grows down its rows, y across its columns; both in the unit of the first of
/// ActionSpace::places, as is every length below, in motion.hpp and in the policies made of them: metres on the
/// tabletop, in `mobile` shares of the picture's height and width.
struct Field {
  double x_low, x_high, y_low, y_high;

  /// @throws InputError for actions without a place in the picture.
  explicit Field(const ActionSpace& actions);
  /// The middle of a pixel, or of a cell.
  Vec2 middle_of(PictureSize picture, int row, int column) const;
};

/// A signed mask of a field: > 0 on the target, < 0 on what is to be avoided. The pixels are somebody else's.
struct FieldMask {
  const float* pixels;
  PictureSize size;
  Field field;

  Vec2 middle_of(int row, int column) const { return field.middle_of(size, row, column); }
  /// False beyond the picture.
  bool is_target(int row, int column) const {
    return row >= 0 && row < size.rows && column >= 0 && column < size.columns &&
           pixels[row * size.columns + column] > 0;
  }
  bool on_target(Vec2 point) const;
  /// The point if its pixel is the target's with two more on every side, else the middle of the nearest that is; of all
  /// target pixels where none is. The point where there is no target.
  Vec2 onto_target(Vec2 point) const;
  /// Centroid of what is to be avoided.
  std::optional<Vec2> avoided() const;
};

/// Finds a point to take hold of. Buffers are kept: looking allocates nothing after the first mask of a size.
class Eye {
 public:
  /// The centroid of one connected piece of the target, onto_target() of that piece: of the piece nearest to `begin`,
  /// of the largest where that is null. None without a target.
  std::optional<Vec2> taken(const FieldMask& mask, const Vec2* begin);

 private:
  struct Piece;
  Piece fill(const FieldMask& mask, int pixel, int id, const Vec2* begin);

  std::vector<int> piece_of_;  // pixel -> 1, 2, ... in reading order; 0 off the target
  std::vector<int> pending_;
  std::vector<float> alone_;  // the mask of one piece
};

}  // namespace lgabench
