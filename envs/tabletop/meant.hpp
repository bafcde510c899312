// Scenes of commands whose meaning is more than one product of types and textures, or which a careless reading takes
// for another: the words, and nothing less, tell the target (docs/protocol.md, section 3).
#pragma once
#include <vector>

#include <lgabench/core/sampling.hpp>
#include <lgabench/core/scene.hpp>
#include <tabletop/task.hpp>

namespace lgabench::tabletop {

/// A target of what `truth` means first; then, where a rule names one, its reference; in a share of
/// `content.misleading` of the scenes another object that belongs (for a rule) and one of `content.near_miss_sets`;
/// last, `content.distractors` that neither truth nor words nor `undecided` hold, with `content.near_miss` such with
/// which all share types and textures alike (alike.hpp). All are placed, and so that grounded() finds the target alone
/// in the picture, with a margin of .08 m for columns and .10 m for distances.
/// @throws NothingToShow where no draw is like that.
std::vector<SceneObject> meant_objects(const Scenario& scenario, const Task& task, const Layout& layout,
                                       const Content& content, const Meaning& truth, const Streams& stream);

}  // namespace lgabench::tabletop
