// Polygons on the table: what sampling, success and shapes need of plane geometry.
#pragma once
#include <vector>

#include <lgabench/core/geometry.hpp>

namespace lgabench::common {

using Polygon = std::vector<Vec2>;  // counter-clockwise, metres, not closed

/// Positive if b lies counter-clockwise of a.
inline double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

/// Area of a simple polygon in m^2; positive for counter-clockwise order.
double area(const Polygon& polygon);

/// The point is in the convex polygon or on its edge.
bool contains(const Polygon& convex, Vec2 point);

/// The convex hull (Andrew's monotone chain), without collinear corners.
Polygon convex_hull(Polygon points);

/// The polygons turned by the yaw about the origin, then moved.
std::vector<Polygon> placed(const std::vector<Polygon>& polygons, Vec2 position_m, double yaw_rad);

/// The smallest distance in metres between two unions of convex polygons; 0 where they overlap, infinity where one of
/// them has no polygon.
double distance(const std::vector<Polygon>& a, const std::vector<Polygon>& b);
/// The distance in metres from a point to the union; 0 within it.
double distance(Vec2 point, const std::vector<Polygon>& polygons);

}  // namespace lgabench::common
