// What a policy sees, and all that it may see.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <lgabench/core/geometry.hpp>

namespace lgabench {

/// One textualized object (paper, section 3.1: s -> phi). `id` is its value in Observation::ids; ids and the order
/// of the table are permuted for each scene, so neither says which object is the target.
struct Instance {
  std::uint8_t id = 0;
  std::string object_type, texture;
  int pixels = 0;  // visible now; 0 if hidden
};

/// The orthographic top view, row-major, row 0 at the smallest x, column 0 at the smallest y, and its textualization.
struct Observation {
  static constexpr int rows = Workspace::rows, columns = Workspace::columns;  // 128 x 256

  std::vector<std::uint8_t> rgb;  // rows x columns x 3
  std::vector<std::uint8_t> ids;  // rows x columns; 0 where there is no object
  std::vector<Instance> instances;
};

}  // namespace lgabench
