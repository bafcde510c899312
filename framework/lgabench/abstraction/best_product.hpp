// The best that one product of types and textures can do for a command: a reference, which knows the truth.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include <lgabench/core/scenario.hpp>

namespace lgabench {

/// For each of the scenario's commands, the product of object types and textures that keeps exactly what is meant in as
/// many of the first `scenes` training scenes, those that give the command, as coordinate ascent finds: one name is
/// added or left out at a time, from the product of all that the truth's sets name, as long as scenes are won. A lower
/// bound of the best. The scenes are those of a training seed that no suite uses. `found` is told of each command that
/// is done. @throws as training_scene().
std::vector<FeatureSet> best_products(const Scenario& scenario, const std::string& layout, int scenes,
                                      const std::function<void()>& found);

}  // namespace lgabench
