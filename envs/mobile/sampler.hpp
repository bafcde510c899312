// From a scenario to scenes.
#pragma once
#include <lgabench/core/environments.hpp>

namespace lgabench::mobile {

/// Scene number `index`. Target, distractors, places and ids come from separate random streams: arms and distributions
/// that differ in one share the rest, but for arms near the first demonstration, which is the training seed's (of tests
/// that all seeds share: seed 0's).
/// @throws InputError where layout, split or arm is unknown; NothingToShow where the distribution holds nothing that
/// can be shown. Error where no room is found.
Scene sample_scene(const Scenario& scenario, const SceneRequest& request, int index);

/// EnvironmentType::with_distractors(), of tasks other than fetch.
Scene with_distractors(const Scenario& scenario, const Scene& scene, int count, bool near_miss, RandomStream random);

/// Whether objects[i] lies on the table and leaves that margin to all others.
bool has_room(const std::vector<SceneObject>& objects, std::size_t i, double margin_m);

constexpr const char* layout = "table";

}  // namespace lgabench::mobile
