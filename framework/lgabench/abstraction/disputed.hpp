// Disputed truths: objects of which two careful readers may disagree whether a command means them.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <lgabench/core/scenario.hpp>

namespace lgabench {

/// Pairs of object type and texture, by the command's words.
using DisputedPairs = std::map<std::string, std::vector<FeatureSet>>;

/// Disputed pairs of a space, from the data directory's disputed/SPACE.json; none where there is no such file. @throws
/// as below.
DisputedPairs disputed_pairs(const FeatureSpace& space);
/// @throws InputError with file and place for what is not as docs/formats says.
DisputedPairs read_disputed(const std::filesystem::path& file, const FeatureSpace& space);

/// Whether the scene shows an object of a pair that is disputed for the command that it gives. Places do not count, nor
/// objects of the task's second set: a pair is of what is to be moved.
bool is_disputed(const DisputedPairs& pairs, const Scenario& scenario, const Scene& scene);

}  // namespace lgabench
