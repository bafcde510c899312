#include <common/outline.hpp>

#include <algorithm>
#include <limits>

namespace lgabench::common {
namespace {

double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }

// An edge of `a` has all of `b` on its outer side (separating axis).
bool has_separating_edge(const Polygon& a, const Polygon& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec2 start = a[i], edge = a[(i + 1) % a.size()] - start;
    if (std::all_of(b.begin(), b.end(), [&](Vec2 p) { return cross(edge, p - start) < 0; })) return true;
  }
  return false;
}

// From the corners of `a` to the edges of `b`.
double corner_distance(const Polygon& a, const Polygon& b) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < b.size(); ++i) {
    const Vec2 start = b[i], edge = b[(i + 1) % b.size()] - start;
    const double length2 = dot(edge, edge);
    for (const Vec2 p : a) {
      const double along = std::clamp(dot(p - start, edge) / length2, 0.0, 1.0);
      const Vec2 gap = p - start - along * edge;
      best = std::min(best, dot(gap, gap));
    }
  }
  return std::sqrt(best);
}

double convex_distance(const Polygon& a, const Polygon& b) {
  if (!has_separating_edge(a, b) && !has_separating_edge(b, a)) return 0;
  return std::min(corner_distance(a, b), corner_distance(b, a));
}

struct Disc {
  Vec2 centre;
  double radius = 0;
};
Disc disc_around(const Polygon& polygon) {
  Disc disc;
  for (const Vec2 p : polygon) disc.centre = disc.centre + (1.0 / static_cast<double>(polygon.size())) * p;
  for (const Vec2 p : polygon) disc.radius = std::max(disc.radius, norm(p - disc.centre));
  return disc;
}

}  // namespace

double area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return twice / 2;
}

bool contains(const Polygon& convex, Vec2 point) {
  for (std::size_t i = 0; i < convex.size(); ++i)
    if (cross(convex[(i + 1) % convex.size()] - convex[i], point - convex[i]) < 0) return false;
  return true;
}

Polygon convex_hull(Polygon points) {
  std::sort(points.begin(), points.end(), [](Vec2 a, Vec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  Polygon hull;
  // The lower chain from left to right, then the upper one back.
  for (int chain = 0; chain < 2; ++chain) {
    const std::size_t first = hull.size();
    for (const Vec2 p : points) {
      while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

std::vector<Polygon> placed(const std::vector<Polygon>& polygons, Vec2 position_m, double yaw_rad) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  std::vector<Polygon> moved = polygons;
  for (Polygon& polygon : moved)
    for (Vec2& p : polygon) p = Vec2{c * p.x - s * p.y, s * p.x + c * p.y} + position_m;
  return moved;
}

double distance(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  std::vector<Disc> discs;  // of b: pairs too far apart to matter are skipped by these
  for (const Polygon& q : b) discs.push_back(disc_around(q));
  double best = std::numeric_limits<double>::infinity();
  for (const Polygon& p : a) {
    const Disc disc = disc_around(p);
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (norm(disc.centre - discs[j].centre) - disc.radius - discs[j].radius >= best) continue;
      best = std::min(best, convex_distance(p, b[j]));
    }
  }
  return best;
}

double distance(Vec2 point, const std::vector<Polygon>& polygons) {
  double best = std::numeric_limits<double>::infinity();
  for (const Polygon& polygon : polygons)
    best = std::min(best, contains(polygon, point) ? 0 : corner_distance({point}, polygon));
  return best;
}

}  // namespace lgabench::common
