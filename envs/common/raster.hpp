// Triangles in a picture: which pixels' centres they hold, in double precision.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include <common/outline.hpp>
#include <lgabench/core/observation.hpp>

namespace lgabench::common {

/// Pixels of the picture: rows first_row..last_row, columns first_column..last_column; none where last < first.
struct Area {
  int first_row, last_row, first_column, last_column;
};
/// What of a picture lies between two corners in pixels: (row, column), whole numbers at pixels' centres.
inline Area area_of(PictureSize picture, Vec2 low, Vec2 high) {
  const auto up = [](double x, int n) { return static_cast<int>(std::ceil(std::clamp(x, 0.0, n + 0.0))); };
  const auto down = [](double x, int n) { return static_cast<int>(std::floor(std::clamp(x, -1.0, n - 1.0))); };
  return {up(low.x, picture.rows), down(high.x, picture.rows), up(low.y, picture.columns),
          down(high.y, picture.columns)};
}

/// Twice the triangle's area; positive if a, b, c run counter-clockwise, as the side of a surface does that faces the
/// eye (or the light).
inline double doubled_area(Vec2 a, Vec2 b, Vec2 c) { return cross(b - a, c - a); }
constexpr double least_area = 1e-9;  // below it, turned away or seen edge-on

/// Calls visit(row, begin, end) for each row in which pixels' centres lie in the triangle, in columns from `begin` to
/// before `end`; not if the triangle is turned away.
template <typename Visit>
void fill(PictureSize picture, Vec2 a, Vec2 b, Vec2 c, const Visit& visit) {
  if (doubled_area(a, b, c) < least_area) return;
  constexpr double slack = 1e-9;  // no gap between neighbours through rounding
  const Area box = area_of(picture, {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})},
                           {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})});
  if (box.first_row > box.last_row || box.first_column > box.last_column) return;
  const std::array<std::array<Vec2, 2>, 3> edges{{{a, b}, {b, c}, {c, a}}};
  std::array<double, 3> slopes;
  for (std::size_t i = 0; i < 3; ++i) slopes[i] = (edges[i][1].y - edges[i][0].y) / (edges[i][1].x - edges[i][0].x);
  for (int row = box.first_row; row <= box.last_row; ++row) {
    double first = box.first_column, last = box.last_column;
    for (std::size_t i = 0; i < 3; ++i) {  // an edge that runs down bounds the row on the left, one that runs up right
      const auto [from, to] = edges[i];
      const double crossing = from.y + slopes[i] * (row - from.x);
      if (to.x > from.x) first = std::max(first, crossing - slack);
      if (to.x < from.x) last = std::min(last, crossing + slack);
    }
    if (first > last) continue;
    const int begin = static_cast<int>(std::ceil(first)), end = static_cast<int>(last) + 1;
    if (begin < end) visit(row, begin, end);
  }
}

}  // namespace lgabench::common
