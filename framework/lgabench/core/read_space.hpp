// The feature space that a file names.
#pragma once
#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/json.hpp>

namespace lgabench {

/// @throws InputError with file and place for a name that no installed space has.
FeatureSpace read_space(const JsonReader& name);

}  // namespace lgabench
