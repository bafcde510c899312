// How each object type is drawn; objects.cpp makes bodies, meshes and outlines of it. Not for other use.
#pragma once
#include <string>
#include <vector>

#include <tabletop/outline.hpp>

namespace lgabench::tabletop {

/// Drawings have u to the right and v up, as the picture shows them at yaw 0; heights z from the table.
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

struct Shape {
  std::string type;
  Drawing (*draw)();
};

/// Every object type, in the order of the feature space. Sizes from PROTOCOL, section 1.
const std::vector<Shape>& shapes();

}  // namespace lgabench::tabletop
