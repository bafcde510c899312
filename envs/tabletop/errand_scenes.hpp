// Scenes of errands: pairs of commands that differ only in how the same objects are used (docs/protocol.md, section 3).
#pragma once
#include <memory>

#include <lgabench/core/environments.hpp>
#include <tabletop/content.hpp>

namespace lgabench::tabletop {

/// What the scenes of an arm, or those to train on, show and for which pair of commands. @pre of an arm: those to train
/// on were read. @throws InputError with file and place of a pair that is none, and of impossible numbers of takes.
std::shared_ptr<const Errands> read_errands(const Scenario& scenario, const JsonReader& file, const JsonReader* scenes,
                                            bool training);

/// How many objects stand in such a scene, with one that appears later.
int objects_of(const Errands& errands);

/// Scene number `index`. In tests, one pair of scenes gives the pair's commands, and all random streams take the pair's
/// number (Scene::pair): the scenes differ in command, judge and roles alone. What is wanted at first are the targets.
/// @throws NothingToShow where no draw is kept: no sequence of takes may be right under both commands, nor may both be
/// done by taking all that is wanted at first.
Scene errand_scene(const Scenario& scenario, const SceneRequest& request, int index);

}  // namespace lgabench::tabletop
