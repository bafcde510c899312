// What one product of types and textures can do at most for a command: a reference, which knows the truth.
#pragma once
#include <string>

#include <lgabench/core/scenario.hpp>

namespace lgabench {

/// The product of object types and textures that keeps exactly what is meant in as many of the scenario's first
/// `scenes` training scenes as coordinate ascent finds: one name is added or left out at a time, from the product of
/// all that the truth's sets name, as long as scenes are won. A lower bound of the best. The scenes are those of a
/// training seed that no suite uses. @throws as training_scene().
FeatureSet best_product(const Scenario& scenario, int command, const std::string& layout, int scenes);

}  // namespace lgabench
