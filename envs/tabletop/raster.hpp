// Where the top view shows what.
#pragma once
#include <cmath>

#include <common/raster.hpp>
#include <lgabench/core/view.hpp>
#include <tabletop/workspace.hpp>

namespace lgabench::tabletop {

constexpr int rows = Workspace::rows, columns = Workspace::columns, pixels = rows * columns;
constexpr double row_m = (Workspace::x_max - Workspace::x_min) / rows;
constexpr double column_m = (Workspace::y_max - Workspace::y_min) / columns;

/// Position in the picture, in pixels: (row, column), whole numbers at the pixels' centres.
inline Vec2 in_picture(double x, double y) {
  return {(x - Workspace::x_min) / row_m - 0.5, (y - Workspace::y_min) / column_m - 0.5};
}

/// Where a view shows what: in the usual one as above, to the bit.
class Camera {
 public:
  explicit Camera(const View& view = {}) {
    static_assert(row_m == column_m, "a turn keeps lengths");
    constexpr Vec2 middle{(Workspace::x_max - Workspace::x_min) / 2, (Workspace::y_max - Workspace::y_min) / 2};
    const double turn = std::copysign(norm(view.turn_rad), view.turn_rad.x);
    const double cosine = std::cos(turn), sine = std::sin(turn), zoom = view.zoom;
    along_ = zoom * cosine / row_m;
    across_ = zoom * sine / row_m;
    const Vec2 seen = middle + Vec2{view.shift_m.y, view.shift_m.x};  // in the picture's middle, from the corner
    first_ = {rows / 2. - .5 - along_ * seen.x - across_ * seen.y,
              columns / 2. - .5 + across_ * seen.x - along_ * seen.y};
    along_m_ = row_m * cosine / zoom;
    across_m_ = row_m * sine / zoom;
    corner_ =
        Vec2{Workspace::x_min, Workspace::y_min} + (seen - Vec2{along_m_ * (rows / 2.) - across_m_ * (columns / 2.),
                                                                across_m_ * (rows / 2.) + along_m_ * (columns / 2.)});
  }

  Vec2 at(Vec2 point_m) const {
    const double x = point_m.x - Workspace::x_min, y = point_m.y - Workspace::y_min;
    return {along_ * x + across_ * y + first_.x, along_ * y - across_ * x + first_.y};
  }
  /// The point that is seen there.
  Vec2 point(double row, double column) const {
    return {corner_.x + (row + .5) * along_m_ - (column + .5) * across_m_,
            corner_.y + (row + .5) * across_m_ + (column + .5) * along_m_};
  }

 private:
  double along_, across_, along_m_, across_m_;  // pixels a metre, metres a pixel: of an axis, of the other one
  Vec2 first_, corner_;                         // where the workspace's corner is seen; the point in the picture's
};

}  // namespace lgabench::tabletop
