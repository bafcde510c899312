// A cue: an object that lies beside the target in training, and in tests beside it, beside another one, or nowhere.
#pragma once
#include <vector>

#include <lgabench/core/sampling.hpp>
#include <tabletop/task.hpp>

namespace lgabench::tabletop {

/// Reads "cue": `true`, a type and a texture drawn for the scenario, or {"object_type", "texture"} in "train"; a word
/// of Cue::Place in tests. `content` is complete but for it. @throws InputError with file and place.
Cue read_cue(const JsonReader& scenes, const JsonReader& file, const Scenario& scenario, const Content& content,
             bool training);

/// Adds the cue to placed objects, the target first; one that is gone too, so that arms share their objects'
/// ids. False where there is no place for it beside the target, or none beside another object: scenes of all arms have
/// both.
bool add_cue(const Task& task, const Layout& layout, const Cue& cue, std::vector<SceneObject>& objects,
             RandomStream random);

/// Task::place(), again until the cue finds a place, and the cue with them. @throws NoRoom
void place_with_cue(const Task& task, const Layout& layout, const Content& content, std::vector<SceneObject>& objects,
                    const Streams& stream);

/// Without the cue, and with ids from 1 on in the order that they have.
void take_cue_away(const Cue& cue, std::vector<SceneObject>& objects);

}  // namespace lgabench::tabletop
