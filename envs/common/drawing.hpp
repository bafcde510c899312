// What object types are drawn with: convex polygons, and solids between horizontal ones. Not for other use.
#pragma once
#include <vector>

#include <common/outline.hpp>

namespace lgabench::common {

/// Drawings have u to the right and v up, as the picture shows them at yaw 0; heights z from the table; all in metres.
struct Drawing {
  /// A convex solid between two horizontal polygons with parallel edges (equal ones make a prism).
  struct Part {
    Polygon bottom, top;
    double z_low = 0, z_high = 0;
  };
  std::vector<Part> parts;
  std::vector<Polygon> outline;  // empty: the parts' own polygons
  Vec2 grasp;
};

/// The point at that distance and direction from the centre, counter-clockwise from u.
Vec2 polar(Vec2 centre, double radius, double degrees);

Polygon rectangle(double left, double bottom, double right, double top);

/// Corners at first, first + 360/n, ... degrees.
Polygon regular(int corners, double radius, double first, Vec2 centre = {});

Polygon disc(double radius, Vec2 centre = {}, int corners = 32);

/// A slanted stroke: from [bottom, bottom + width] at v = low to [top, top + width] at v = high.
Polygon slanted(double low, double bottom, double high, double top, double width);

/// The other side of the v axis.
Polygon mirrored(const Polygon& polygon);

/// A band between two radii, from one direction counter-clockwise to another, in degrees; in convex pieces, each with
/// two outer segments over one inner chord.
std::vector<Polygon> arc(Vec2 centre, double inner, double outer, double from, double to, int pieces);

Drawing::Part prism(const Polygon& polygon, double z_low, double z_high);

/// Every edge moved inwards. @pre No edge vanishes.
Polygon inset(const Polygon& convex, double by);

/// How far a solid is drawn in at a height.
struct Level {
  double z, inset;
};

/// Adds the solid through these levels, lowest first, and its outline. @pre The smallest inset is 0.
void add_solid(Drawing& drawing, const Polygon& convex, const std::vector<Level>& levels);

}  // namespace lgabench::common
