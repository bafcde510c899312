// Where the objects of a scene stand.
#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/random.hpp>
#include <lgabench/core/scenario.hpp>

namespace lgabench::tabletop {

/// Where objects of a task may stand (docs/protocol.md, section 3). Without places: anywhere, at any yaw.
struct Layout {
  Task task;
  std::string id;
  std::vector<Vec2> target_places, distractor_places;
  std::optional<Vec2> pallet = {};
  double widest_m = unbounded, widest_target_m = unbounded;  // of the types that it can show
  double shift_m = 0;                                        // sweep: the target stands up to this far from its place
  static constexpr double unbounded = std::numeric_limits<double>::infinity();
};

/// Lives as long as the program. @throws InputError that lists the task's layouts.
const Layout& find_layout(Task task, const std::string& id);

/// A scene's random streams by what they are for.
using Streams = std::function<RandomStream(const std::string& purpose)>;

/// Sets position and yaw of every object but the goal. objects[0] is a target and takes its place first, from a stream
/// of its own, so that scenes with other distractors share it. A distractor that finds no place is left out (fixed
/// places). In sweep, distractors of a choice stand in the free way (touching them is allowed) instead of in the other
/// row. @throws Error where free places run out.
void place(const Layout& layout, const SceneContent& content, std::vector<SceneObject>& objects, const Streams& stream);

}  // namespace lgabench::tabletop
