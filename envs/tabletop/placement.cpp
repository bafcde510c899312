#include <tabletop/placement.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <common/objects.hpp>
#include <lgabench/core/error.hpp>
#include <tabletop/workspace.hpp>

namespace lgabench::tabletop {
namespace {

constexpr double margin_m = 0.02;  // between outlines

bool inside_picture(const std::vector<Polygon>& outline) {
  for (const Polygon& polygon : outline)
    if (!std::all_of(polygon.begin(), polygon.end(), Workspace::contains)) return false;
  return true;
}

using Outline = std::vector<Polygon>;

// What is taken already.
struct Taken {
  std::vector<Outline> bodies, room;  // room: the goal, and what motions need
};

bool clear_of(const Outline& outline, const std::vector<Outline>& others, double margin = margin_m) {
  return std::all_of(others.begin(), others.end(),
                     [&](const Outline& other) { return distance(outline, other) >= margin; });
}

Outline outline_of(const SceneObject& object) {
  return placed_outline(model_of(object), object.position_m, object.yaw_rad);
}

// A uniform place and yaw, and then false where it does not leave the margin to all that is taken.
bool try_place(const Room& room_of, SceneObject& object, Taken& taken, RandomStream& random) {
  object.position_m.x = random.uniform(Workspace::x_min, Workspace::x_max);
  object.position_m.y = random.uniform(Workspace::y_min, Workspace::y_max);
  object.yaw_rad = random.uniform(-pi, pi);
  Outline outline = outline_of(object);
  if (!inside_picture(outline) || !clear_of(outline, taken.bodies) || !clear_of(outline, taken.room)) return false;
  if (object.role == role::target) {
    Outline room = room_of(object);
    if (!inside_picture(room) || !clear_of(room, taken.bodies)) return false;
    taken.room.push_back(std::move(room));
  }
  taken.bodies.push_back(std::move(outline));
  return true;
}

bool place_others(const Room& room_of, int tries, std::vector<SceneObject>& objects, Taken taken,
                  RandomStream& random) {
  for (std::size_t i = 1; i < objects.size(); ++i) {
    int k = 0;
    while (k < tries && !try_place(room_of, objects[i], taken, random)) ++k;
    if (k == tries) return false;
  }
  return true;
}

}  // namespace

const ObjectModel& model_of(const SceneObject& object) { return object_model(object.object_type, object.scale); }

bool can_show(const std::string& type, double widest_m) {
  if (type == goal_type) return false;
  const Vec2 size = object_model(type).size_m;
  return std::max(size.x, size.y) <= widest_m + 1e-9;
}

void place_on_cells(const Layout& layout, std::vector<SceneObject>& objects, RandomStream random) {
  const Vec2 target = layout.target_places[random.below(static_cast<std::uint32_t>(layout.target_places.size()))];
  std::vector<Vec2> free;
  for (const int i : random.permutation(static_cast<int>(layout.distractor_places.size()))) {
    const Vec2 place = layout.distractor_places[static_cast<std::size_t>(i)];
    if (norm(place - target) > 0) free.push_back(place);
  }
  objects[0].position_m = target;
  objects.resize(std::min(objects.size(), 1 + free.size()));
  for (std::size_t i = 1; i < objects.size(); ++i) objects[i].position_m = free[i - 1];
}

bool has_room(const Room& room_of, const std::vector<SceneObject>& objects, std::size_t i, double margin_m) {
  std::vector<Outline> goals, bodies;
  for (std::size_t k = 0; k < objects.size(); ++k)
    if (k != i) (objects[k].role == role::goal ? goals : bodies).push_back(outline_of(objects[k]));
  const auto fits = [&](const Outline& outline, const std::vector<Outline>& others) {
    return inside_picture(outline) && clear_of(outline, others, margin_m);
  };
  const Outline outline = outline_of(objects[i]);
  if (!fits(outline, bodies) || !fits(outline, goals)) return false;
  return objects[i].role != role::target || fits(room_of(objects[i]), bodies);
}

bool place_last(const Room& room_of, std::vector<SceneObject>& objects, RandomStream& random) {
  constexpr int tries = 500;
  Taken taken;
  for (std::size_t i = 0; i + 1 < objects.size(); ++i) {
    (objects[i].role == role::goal ? taken.room : taken.bodies).push_back(outline_of(objects[i]));
    if (objects[i].role == role::target) taken.room.push_back(room_of(objects[i]));
  }
  for (int i = 0; i < tries; ++i)
    if (try_place(room_of, objects.back(), taken, random)) return true;
  return false;
}

bool place_beside(const Layout& layout, const Room& room_of, std::vector<SceneObject>& objects, std::size_t i,
                  double near_m, double far_m, RandomStream& random) {
  constexpr int directions = 64, steps = 20;
  constexpr double least_margin_m = .002, least_step_m = 1e-4;
  Taken taken;
  for (std::size_t k = 0; k + 1 < objects.size(); ++k) {
    if (k != i) taken.bodies.push_back(outline_of(objects[k]));
    if (objects[k].role == role::target) taken.room.push_back(room_of(objects[k]));
  }
  if (layout.pallet) taken.room.push_back(placed_outline(object_model(goal_type), *layout.pallet, 0));
  const SceneObject& other = objects[i];
  const Outline there = outline_of(other);
  SceneObject& placed = objects.back();
  std::optional<SceneObject> nearest;
  double nearest_m = near_m;
  for (int n = 0; n < directions; ++n) {
    const double direction = random.uniform(-pi, pi);
    placed.yaw_rad = random.uniform(-pi, pi);
    Outline outline;
    double away_m = model_of(other).radius_m + model_of(placed).radius_m + least_margin_m, left_m = 1;
    for (int step = 0; step < steps && left_m > least_step_m; ++step) {
      placed.position_m = other.position_m + rotated({away_m, 0}, direction);
      outline = outline_of(placed);
      left_m = distance(outline, there) - least_margin_m;
      away_m = std::max(0.0, away_m - left_m);
    }
    const double gap_m = distance(other.position_m, outline);
    if (gap_m > nearest_m || (i > 0 && distance(objects[0].position_m, outline) < far_m)) continue;
    if (!inside_picture(outline) || !clear_of(outline, taken.bodies) || !clear_of(outline, taken.room)) continue;
    nearest_m = gap_m;
    nearest = placed;
  }
  if (nearest) placed = *nearest;
  return nearest.has_value();
}

void place_freely(const Layout& layout, const Room& room, const Patience& patience, std::vector<SceneObject>& objects,
                  const Streams& stream) {
  constexpr int tries = 10000;
  RandomStream random = stream("layout"), others = stream("layout of distractors");
  Taken nothing;
  if (layout.pallet) nothing.room.push_back(placed_outline(object_model(goal_type), *layout.pallet, 0));
  int placed = 0;
  for (int k = 0; k < tries && placed < patience.targets; ++k) {
    Taken taken = nothing;
    if (!try_place(room, objects[0], taken, random)) continue;
    ++placed;
    for (int again = 0; again < patience.anew; ++again)
      if (place_others(room, patience.places, objects, taken, others)) return;
  }
  throw NoRoom(fmt::format("layout {}: no room found for {} objects in {} tries", layout.id, objects.size(), tries));
}

}  // namespace lgabench::tabletop
