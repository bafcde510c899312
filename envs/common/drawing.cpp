#include <common/drawing.hpp>

#include <algorithm>
#include <cmath>

namespace lgabench::common {
Vec2 polar(Vec2 centre, double radius, double degrees) {
  return centre + Vec2{radius * std::cos(degrees * pi / 180), radius * std::sin(degrees * pi / 180)};
}

Polygon rectangle(double left, double bottom, double right, double top) {
  return {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
}

Polygon regular(int corners, double radius, double first, Vec2 centre) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) polygon.push_back(polar(centre, radius, first + 360.0 * i / corners));
  return polygon;
}

Polygon disc(double radius, Vec2 centre, int corners) { return regular(corners, radius, 0, centre); }

Polygon slanted(double low, double bottom, double high, double top, double width) {
  return {{bottom, low}, {bottom + width, low}, {top + width, high}, {top, high}};
}

Polygon mirrored(const Polygon& polygon) {
  Polygon other;
  for (const Vec2 p : polygon) other.push_back({-p.x, p.y});
  std::reverse(other.begin(), other.end());
  return other;
}

std::vector<Polygon> arc(Vec2 centre, double inner, double outer, double from, double to, int pieces) {
  std::vector<Polygon> all;
  const double step = (to - from) / pieces;
  for (int i = 0; i < pieces; ++i) {
    const double a = from + i * step;
    all.push_back({polar(centre, inner, a), polar(centre, outer, a), polar(centre, outer, a + step / 2),
                   polar(centre, outer, a + step), polar(centre, inner, a + step)});
  }
  return all;
}

Drawing::Part prism(const Polygon& polygon, double z_low, double z_high) { return {polygon, polygon, z_low, z_high}; }

Polygon inset(const Polygon& convex, double by) {
  if (by == 0) return convex;
  const std::size_t n = convex.size();
  Polygon smaller;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 before = convex[i] - convex[(i + n - 1) % n], after = convex[(i + 1) % n] - convex[i];
    const Vec2 a = (1 / norm(before)) * before, b = (1 / norm(after)) * after;
    const double along = by / (a.x * b.y - a.y * b.x);  // the corner lies `by` from both edges
    smaller.push_back(convex[i] + along * (b - a));
  }
  return smaller;
}

void add_solid(Drawing& drawing, const Polygon& convex, const std::vector<Level>& levels) {
  drawing.outline.push_back(convex);
  for (std::size_t i = 0; i + 1 < levels.size(); ++i)
    drawing.parts.push_back(
        {inset(convex, levels[i].inset), inset(convex, levels[i + 1].inset), levels[i].z, levels[i + 1].z});
}

}  // namespace lgabench::common
