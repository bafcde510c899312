// How each object type is drawn; objects.cpp makes bodies, meshes and outlines of it. Not for other use.
#pragma once
#include <string>
#include <vector>

#include <common/drawing.hpp>

namespace lgabench::common {

struct Shape {
  std::string type;
  Drawing (*draw)();
};

/// The paper's object types, in the order of the tabletop space. Sizes: docs/gallery.md.
const std::vector<Shape>& shapes();

/// What the household space has beyond the tabletop's, in its order.
const std::vector<Shape>& household_shapes();

/// Shapes of the household space that standing_model() shows upright.
const std::vector<Shape>& standing_shapes();

}  // namespace lgabench::common
