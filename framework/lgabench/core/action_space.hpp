// What the numbers of an action mean, as data.
#pragma once
#include <array>
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>

namespace lgabench {

/// One number of an action.
struct ActionNumber {
  std::string name, unit;  // "pose0.x", "m"; "" for a number without a unit
  double low, high;        // what is outside is clipped by the environment
};

/// All of them, in the order in which methods, files and the protocol have them.
struct ActionSpace {
  std::vector<ActionNumber> numbers;
  std::vector<std::array<std::size_t, 4>> rotations;  // which numbers form a unit quaternion x, y, z, w
};

/// [{"name", "unit", "low", "high"}, ...]: the protocol's hello.
Json to_json(const ActionSpace& space);

/// The space of `Action` (core/action.hpp): two poses on the table.
const ActionSpace& two_poses();

}  // namespace lgabench
