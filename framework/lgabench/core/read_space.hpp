// Where feature spaces are, and the one that a file names.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/json.hpp>

namespace lgabench {

/// Ids of all spaces: the data directory's spaces/, then files on the scenario path that have "object_types".
std::vector<std::string> feature_space_ids();

/// The file of the space named `id`. @throws InputError where there is none.
std::filesystem::path feature_space_file(const std::string& id);

/// @throws InputError with file and place for a name that no installed space has.
FeatureSpace read_space(const JsonReader& name);

}  // namespace lgabench
