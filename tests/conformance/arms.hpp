// Arms that are worth playing: wordings, and what is perceived, change no scene.
#pragma once
#include <set>
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>
#include <tabletop/sampler.hpp>

#include "amount.hpp"

namespace lgabench::tabletop {

/// Test arms whose first scenes hold other objects than those of an arm before; all in `./test --full`.
inline std::vector<std::string> arms_of_other_scenes(const Scenario& scenario, const std::string& layout) {
  std::vector<std::string> arms;
  std::set<std::string> seen;
  for (const Arm& arm : scenario.tests) {
    std::string objects;
    for (int i = 0; i < 20; ++i)
      objects += canonical(to_json(sample_scene(scenario, {layout, "test", arm.id, 200}, i))["objects"]);
    if (seen.insert(objects).second || amount(0, 1) == 1) arms.push_back(arm.id);
  }
  return arms;
}

}  // namespace lgabench::tabletop
