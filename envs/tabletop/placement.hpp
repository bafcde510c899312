// Where the objects of a scene stand.
#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <common/objects.hpp>
#include <common/outline.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/core/sampling.hpp>
#include <lgabench/core/scene.hpp>
#include <tabletop/workspace.hpp>

namespace lgabench::tabletop {

/// What things are brought to: fixed to the table, and never anything else in a scene.
constexpr const char *goal_type = "pallet", *goal_texture = "wooden";

namespace role {
using namespace lgabench::role;
/// An object that belongs to what a command says, and is not the one that it means.
inline constexpr const char* not_meant = "not_meant";
/// An object of an errand that stands there after the first take.
inline constexpr const char* later = "later";
}  // namespace role

/// The model of an object of a scene.
const ObjectModel& model_of(const SceneObject& object);

/// Whether a scene may hold objects of that type beside its goal: none wider than that, and no second goal.
bool can_show(const std::string& type, double widest_m);

/// Where objects of a task may stand (docs/protocol.md, section 3). Without places: anywhere, at any yaw.
struct Layout {
  std::string id;
  std::vector<Vec2> target_places = {}, distractor_places = {};
  std::optional<Vec2> pallet = {};                           // a goal stands there
  double widest_m = unbounded, widest_target_m = unbounded;  // of the types that it can show
  double shift_m = 0;                                        // the target stands up to this far from its place
  static constexpr double unbounded = std::numeric_limits<double>::infinity();
};

/// What must stay free beside a target for its motion.
using Room = std::function<std::vector<Polygon>(const SceneObject& target)>;

/// The target's place first, then the others' without repetition; one that finds no place is left out.
void place_on_cells(const Layout& layout, std::vector<SceneObject>& objects, RandomStream random);

/// Whether objects[i] lies within the picture and leaves that margin to all others, and a target's motion too.
bool has_room(const Room& room, const std::vector<SceneObject>& objects, std::size_t i, double margin_m);

/// Places the last among the others, with the margin that all of a scene leave; false where no place is found.
bool place_last(const Room& room, std::vector<SceneObject>& objects, RandomStream& random);

/// Places the last beside objects[i]: with the usual margin to all others, and .002 m to that one, from the direction,
/// of many that are drawn, in which it comes nearest to its centre. The nearest of it is then within `near_m` of that
/// centre and, unless objects[i] is the target, objects[0], no nearer than `far_m` to the target's. False where no such
/// place is found.
bool place_beside(const Layout& layout, const Room& room, std::vector<SceneObject>& objects, std::size_t i,
                  double near_m, double far_m, RandomStream& random);

/// Places were tried for as long as is worth it.
class NoRoom : public Error {
 public:
  using Error::Error;
};

/// How long room is looked for: places that the target can have; with each, how often the others are placed anew;
/// places of each of them.
struct Patience {
  int targets = 10000, anew = 1;
  int places = 5000;  // many, since the next target place would no longer be that of the other arms
};

/// Uniform places and yaws that leave a margin between all outlines, and between them and the room that targets need.
/// @throws NoRoom
void place_freely(const Layout& layout, const Room& room, const Patience& patience, std::vector<SceneObject>& objects,
                  const Streams& stream);

}  // namespace lgabench::tabletop
