// Whose test scenes a cell plays.
#pragma once
#include <cstdint>
#include <vector>

#include <lgabench/core/json.hpp>

namespace lgabench {

/// Test scenes shared by all training seeds, or of each training seed its own.
enum class TestScenes { shared, per_seed };
/// "shared" or "per_seed", as files have it.
void to_json(Json& json, TestScenes scenes);
/// @throws InputError for another word.
TestScenes read_test_scenes(const JsonReader& reader);

/// The number of the set of scenes that a training seed plays: its own, or 0, everybody's.
std::uint64_t scene_set(TestScenes scenes, std::uint64_t training_seed);
/// The numbers for all the training seeds.
std::vector<std::uint64_t> scene_sets(TestScenes scenes, const std::vector<std::uint64_t>& training_seeds);

}  // namespace lgabench
