// From a scenario to scenes.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <lgabench/core/environments.hpp>
#include <tabletop/near_misses.hpp>

namespace lgabench::tabletop {

/// Scene number `index`. Layout, target features, distractors and ids come from separate random streams, so that two
/// distributions, and a scenario's arms, share target places. (In `continuous`, where a target's shape does not fit,
/// the next place is tried. For sweep it shifts the target only.)
/// @throws InputError where layout, split or arm is unknown, or the layout has no place for all of a choice;
/// NothingToShow where the distribution holds nothing that the layout, or the choice, can show. Error where no room is
/// found.
Scene sample_scene(const Scenario& scenario, const SceneRequest& request, int index);

/// EnvironmentType::with_distractors(). No uniform one is wider than .18 m. Where 20 draws find no room for all, what
/// is left is uniform and no wider than .12.
Scene with_distractors(const Scenario& scenario, const Scene& scene, int count, bool near_miss, RandomStream random);

/// The members of what the scenario's command means that all of its scenes can show in that layout, in an order drawn
/// for the training seed; training shows the first of them (Content::members). Fewer are among more, and all suites
/// that give one command share them.
std::vector<Features> members_of(const Scenario& scenario, const std::string& layout, int command,
                                 std::uint64_t training_seed);

/// Whether both have one value of what decides, of an axis of which the command leaves something out: the object type,
/// the texture, or either.
bool shares_what_decides(const FeatureSet& meant, const FeatureSpace& space, const Features& one,
                         const Features& other);

}  // namespace lgabench::tabletop
