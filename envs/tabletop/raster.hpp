// Where the top view shows what.
#pragma once
#include <common/raster.hpp>
#include <tabletop/workspace.hpp>

namespace lgabench::tabletop {

constexpr int rows = Workspace::rows, columns = Workspace::columns, pixels = rows * columns;
constexpr double row_m = (Workspace::x_max - Workspace::x_min) / rows;
constexpr double column_m = (Workspace::y_max - Workspace::y_min) / columns;

/// Position in the picture, in pixels: (row, column), whole numbers at the pixels' centres.
inline Vec2 in_picture(double x, double y) {
  return {(x - Workspace::x_min) / row_m - 0.5, (y - Workspace::y_min) / column_m - 0.5};
}

}  // namespace lgabench::tabletop
