// How a scene is looked at: camera, light and table, beside what stands there.
#pragma once
#include <string>

#include <lgabench/core/geometry.hpp>

namespace lgabench {

/// Towards the usual light, a unit vector: from above, the top view's upper left. Shadows fall to the lower right.
inline constexpr Vec3 usual_light{-0.36, -0.48, 0.8};

/// A view; by default the usual one. Lengths in metres, angles in radians.
struct View {
  Vec2 shift_m;     // of the camera: x along the picture's rows, to the right, y along its columns, down
  Vec2 turn_rad;    // of the camera: x to the left, y down; one that looks straight down, without perspective, turns
                    // about its axis instead: by the length, counter-clockwise where x is positive
  double zoom = 1;  // of what the picture's middle shows
  Vec3 light = usual_light;  // towards it, a unit vector above the table
  std::string table;         // the texture that lies on the table; "": the table's own colour
};

inline bool operator==(const View& a, const View& b) {
  return a.shift_m.x == b.shift_m.x && a.shift_m.y == b.shift_m.y && a.turn_rad.x == b.turn_rad.x &&
         a.turn_rad.y == b.turn_rad.y && a.zoom == b.zoom && a.light.x == b.light.x && a.light.y == b.light.y &&
         a.light.z == b.light.z && a.table == b.table;
}
inline bool operator!=(const View& a, const View& b) { return !(a == b); }

}  // namespace lgabench
