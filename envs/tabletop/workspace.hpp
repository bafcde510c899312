// The table's working area, and the picture that covers it.
#pragma once
#include <lgabench/core/geometry.hpp>
#include <lgabench/core/observation.hpp>

namespace lgabench::common {}

namespace lgabench::tabletop {

using namespace common;  // what things look like

/// VIMA's workspace in metres, seen from straight above without perspective. Picture rows run along +x (row 0 at
/// x_min), columns along +y (column 0 at y_min); z points at the camera.
struct Workspace {
  static constexpr double x_min = 0.25, x_max = 0.75, y_min = -0.5, y_max = 0.5;
  static constexpr int rows = 128, columns = 256;
  static constexpr PictureSize picture{rows, columns};
  /// Edges included.
  static bool contains(Vec2 p) { return p.x >= x_min && p.x <= x_max && p.y >= y_min && p.y <= y_max; }
};

}  // namespace lgabench::tabletop
