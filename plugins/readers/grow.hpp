// Grows a forest, with OpenCV.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <readers/forest.hpp>

namespace lgabench::seeing {

/// Rows of numbers, and the class of each.
struct Examples {
  std::vector<std::vector<float>> rows;
  std::vector<int> classes;
};

struct ForestSize {
  int trees = 64, tried = 0;  // features that a split is chosen from; 0: the root of all
};

/// Takes some seconds. Draws from OpenCV's generator with that seed: another version of it may grow other trees.
/// @throws InputError for a tree of more than 65,535 nodes.
Forest grown(const Examples& examples, const std::vector<std::string>& classes, ForestSize size, std::uint64_t seed);

}  // namespace lgabench::seeing
