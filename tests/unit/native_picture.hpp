// Places in the camera's picture of the tabletop, for tests that paint in it.
#pragma once
#include <lgabench/core/observation.hpp>
#include <tabletop/two_poses.hpp>

namespace lgabench {

inline constexpr PictureSize native_size = tabletop::Workspace::picture;
inline constexpr int rows = tabletop::Workspace::rows, columns = tabletop::Workspace::columns;
inline constexpr double pixel = 1.0 / columns;  // m
inline const Vec2 goal{.5, .3};

inline Vec2 place(int row, int column) {
  return {tabletop::Workspace::x_min + row * pixel, tabletop::Workspace::y_min + column * pixel};
}

}  // namespace lgabench
