// From a scenario to scenes.
#pragma once
#include <lgabench/core/environments.hpp>

namespace lgabench::tabletop {

/// Scene number `index`. Layout, target features, distractors and ids come from separate random streams, so that two
/// distributions, and a scenario's arms, share target places. (In `continuous`, where a target's shape does not fit,
/// the next place is tried. For sweep it shifts the target only.)
/// @throws InputError where layout, split or arm is unknown, or the layout has no place for all of a choice;
/// NothingToShow where the distribution holds nothing that the layout, or the choice, can show. Error where no room is
/// found.
Scene sample_scene(const Scenario& scenario, const SceneRequest& request, int index);

}  // namespace lgabench::tabletop
