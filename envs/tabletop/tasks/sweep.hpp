// Parts of sweep that tests look at alone.
#pragma once
#include <vector>

#include <common/outline.hpp>
#include <lgabench/core/physics_world.hpp>
#include <lgabench/core/scene.hpp>
#include <tabletop/workspace.hpp>

namespace lgabench::tabletop {

/// A target or the spatula touch an obstacle now: in a contact (of the last step), or their outlines overlap seen from
/// above, since a thin obstacle is passed over without contact. `spatula` is its outline, empty where it is not on the
/// table. @throws InputError where the scene lacks a target or an obstacle.
bool touches_obstacle(const Scene& scene, const std::vector<Pose>& poses, const std::vector<Contact>& contacts,
                      const std::vector<Polygon>& spatula);

}  // namespace lgabench::tabletop
