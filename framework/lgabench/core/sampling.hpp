// What samplers of scenes share: what may be asked of them, random streams by purpose, ids that reveal nothing.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench {

/// Scene number `index` as the request has it, without objects and parameters; the arm's commands take turns.
/// @throws InputError for a split or an arm that there is not, a training seed's own scenes outside of tests, an index
/// below 0.
Scene without_objects(const Scenario& scenario, const SceneRequest& request, int index);

/// A scene's random streams by what they are for. A value.
using Streams = std::function<RandomStream(const std::string& purpose)>;

/// What the names of a scene's streams begin with.
std::string stream_name(const std::string& scenario, const SceneRequest& request, int index);
/// The streams of scene number `index`. The arm is no part of them: arms are compared scene by scene.
Streams streams_of(const Scenario& scenario, const SceneRequest& request, int index);
/// The same under another scenario's id: scenes of several scenarios that are to be one.
Streams streams_of(const std::string& scenario, const SceneRequest& request, int index);

/// Any of them, with equal odds. @pre there is one.
const std::string& any_of(const std::vector<std::string>& names, RandomStream& random);

/// Gives ids 1..n in random order and sorts the objects by them: neither reveals a role.
void permute_ids(std::vector<SceneObject>& objects, RandomStream random);

}  // namespace lgabench
