// What the task fetch puts objects on or into, and where that stands (docs/protocol.md, section 7).
#pragma once
#include <array>
#include <string>
#include <vector>

#include <lgabench/core/action.hpp>
#include <lgabench/core/scene.hpp>
#include <mobile/place.hpp>

namespace lgabench::mobile {

/// Tray, box and plate on a stand: their types, in the feature space's order.
const std::vector<std::string>& receiver_types();
bool is_receiver(const std::string& type);

/// The model of a receiver, which has one size, or of an object as it stands in life. @throws InputError for an unknown
/// type.
const ObjectModel& model_of(const std::string& type, double scale = 1);
inline const ObjectModel& model_of(const SceneObject& object) { return model_of(object.object_type, object.scale); }

/// What a receiver of that type holds, standing at a place on the table. @pre is_receiver(type)
Vessel vessel_of(const std::string& type, Vec2 place);

/// The places along the table's far side where receivers stand.
constexpr std::array<Vec2, 5> stations{{{1.175, -.48}, {1.175, -.24}, {1.175, 0}, {1.175, .24}, {1.175, .48}}};
/// Where the robot stands to reach one: before it, at the table's near side. It looks along +x there.
constexpr Vec2 before(Vec2 station) { return {.25, station.y}; }

/// Where objects stand: before the receivers.
constexpr Rectangle fetch_zone{{.69, -.42}, {.97, .42}};

/// Plan as numbers, all but whose grasp are a station's.
const ActionSpace& fetch_plans();

}  // namespace lgabench::mobile
