// Scenes of persons, who do not say which of what their words hold they take (docs/protocol.md, section 3).
#pragma once
#include <memory>
#include <vector>

#include <lgabench/core/sampling.hpp>
#include <lgabench/core/scene.hpp>
#include <tabletop/task.hpp>

namespace lgabench::tabletop {

/// Words and rule of each command of a scenario with "persons". @throws InputError with the place of a truth that is no
/// rule of the grammar for the command's words, or fits no object.
std::shared_ptr<const Persons> read_persons(const Scenario& scenario, const JsonReader& file);

/// What stands in a scene of that person. Tests: five objects, each plainly what another rule takes, one of them the
/// person's. Training: five of what the words hold, of which the rule takes some, and the target is any of these.
/// Nothing but the targets' role depends on the person's rule more than on its rivals'. @throws NothingToShow where no
/// draw is like that.
std::vector<SceneObject> rival_objects(const Scenario& scenario, const Task& task, const Layout& layout,
                                       const Content& content, int person, bool training, const Streams& stream);

}  // namespace lgabench::tabletop
