// Members of scenes that several environments read from a scenario's file.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/scenario.hpp>

namespace lgabench::common {

/// Features that near misses are made of first, before others that the command does not mean.
struct NearMiss {
  std::vector<std::string> object_types, textures;  // empty: any
  bool alike = false;                               // textures with the target's colours in another pattern
  bool size_matched = false;                        // each object scaled to the same area
};

/// `true`, or lists of names of the space that none of the scenario's commands means, or {"alike": true}; beside
/// them {"size": "matched"}. @throws InputError
NearMiss read_near_miss(const JsonReader& reader, const Scenario& scenario);

/// [fewest, most], within 0 and `most`. @throws InputError
std::pair<int, int> read_distractors(const JsonReader& reader, int most);

}  // namespace lgabench::common
