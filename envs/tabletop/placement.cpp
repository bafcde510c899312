#include <tabletop/placement.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

#include <lgabench/core/error.hpp>
#include <tabletop/objects.hpp>
#include <tabletop/sampler.hpp>

namespace lgabench::tabletop {
namespace {

constexpr double margin_m = 0.02;  // between outlines

// The spatula is .12 wide: wider targets slip off it. Obstacle and distractors stand where the target's place says.
Layout sweep_layout(const std::string& id, double shift_m) {
  const std::vector<Vec2> places{{.375, -.05}, {.375, .05}, {.625, -.05}, {.625, .05}};
  return {Task::sweep, id, places, {}, {}, Layout::unbounded, .145, shift_m};
}

const std::vector<Layout>& all_layouts() {
  constexpr Vec2 pallet{.5, .3};
  static const std::vector<Vec2> cells{{.375, -.36}, {.625, -.36}, {.375, -.06}, {.625, -.06}};
  static const std::vector<Vec2> rotate_cells{{.40, -.35}, {.60, -.115}, {.40, .115}, {.60, .35}};
  // The authors' five places: targets in the first two, distractors in the second and third.
  const std::vector<Vec2> released_targets{{.34375, -.265625}, {.34375, .125}};
  const std::vector<Vec2> released_distractors{{.34375, .125}, {.625, -.265625}};
  constexpr Vec2 released_pallet{.625, .125};
  constexpr double released_widest = .17;
  static const std::vector<Layout> all{
      {Task::pick_and_place, "cells", cells, cells, pallet},
      {Task::pick_and_place, "continuous", {}, {}, pallet},
      {Task::pick_and_place, "released", released_targets, released_distractors, released_pallet, released_widest},
      {Task::rotate, "cells", rotate_cells, rotate_cells},
      {Task::rotate, "continuous", {}, {}},
      {Task::rotate, "released", released_targets, released_distractors, {}, released_widest},
      sweep_layout("cells", 0),
      sweep_layout("continuous", .03),
      sweep_layout("released", 0)};
  return all;
}

// The target's place first, then the distractors' without repetition; a distractor that finds no place is left out.
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

bool inside_picture(const std::vector<Polygon>& outline) {
  for (const Polygon& polygon : outline)
    if (!std::all_of(polygon.begin(), polygon.end(), Workspace::contains)) return false;
  return true;
}

// What must stay free beside the target itself: where a large one reaches beyond the pallet that it is brought to, or
// the disc that a rotation sweeps.
std::vector<Polygon> room_for_motion(const Layout& layout, const SceneObject& target) {
  const ObjectModel& model = object_model(target.object_type);
  if (layout.pallet) return placed_outline(model, *layout.pallet, target.yaw_rad);
  constexpr int corners = 32;
  Polygon disc;
  for (int i = 0; i < corners; ++i)  // around the disc, not in it
    disc.push_back(target.position_m + rotated({model.radius_m / std::cos(pi / corners), 0}, 2 * pi * i / corners));
  return {disc};
}

using Outline = std::vector<Polygon>;

// What is taken already.
struct Taken {
  std::vector<Outline> bodies, room;  // room: the goal, and what motions need
};

bool clear_of(const Outline& outline, const std::vector<Outline>& others) {
  return std::all_of(others.begin(), others.end(),
                     [&](const Outline& other) { return distance(outline, other) >= margin_m; });
}

// A uniform place and yaw, and then false where it does not leave the margin to all that is taken.
bool try_place(const Layout& layout, SceneObject& object, Taken& taken, RandomStream& random) {
  object.position_m.x = random.uniform(Workspace::x_min, Workspace::x_max);
  object.position_m.y = random.uniform(Workspace::y_min, Workspace::y_max);
  object.yaw_rad = random.uniform(-pi, pi);
  Outline outline = placed_outline(object_model(object.object_type), object.position_m, object.yaw_rad);
  if (!inside_picture(outline) || !clear_of(outline, taken.bodies) || !clear_of(outline, taken.room)) return false;
  if (object.role == Role::target) {
    Outline room = room_for_motion(layout, object);
    if (!inside_picture(room) || !clear_of(room, taken.bodies)) return false;
    taken.room.push_back(std::move(room));
  }
  taken.bodies.push_back(std::move(outline));
  return true;
}

bool place_others(const Layout& layout, std::vector<SceneObject>& objects, Taken taken, RandomStream& random) {
  constexpr int tries = 5000;  // many, since the next target place would no longer be that of the other arms
  for (std::size_t i = 1; i < objects.size(); ++i) {
    int k = 0;
    while (k < tries && !try_place(layout, objects[i], taken, random)) ++k;
    if (k == tries) return false;
  }
  return true;
}

void place_freely(const Layout& layout, std::vector<SceneObject>& objects, const Streams& stream) {
  constexpr int tries = 10000;
  RandomStream random = stream("layout"), others = stream("layout of distractors");
  Taken nothing;
  if (layout.pallet) nothing.room.push_back(placed_outline(object_model(goal_type), *layout.pallet, 0));
  for (int k = 0; k < tries; ++k) {
    Taken taken = nothing;
    if (try_place(layout, objects[0], taken, random) && place_others(layout, objects, std::move(taken), others)) return;
  }
  throw Error(fmt::format("layout {}: no room found for {} objects in {} tries", layout.id, objects.size(), tries));
}

// docs/protocol.md, section 3 and 4: obstacles bar one side of the target's row, distractors stand in the other row, or
// where they bar the way themselves opposite the obstacle.
void place_for_sweep(const Layout& layout, const SceneContent& content, std::vector<SceneObject>& objects,
                     const Streams& stream) {
  constexpr double distractor_y_m = .16;
  RandomStream random = stream("layout"), others = stream("layout of distractors"), distance = stream("distance");
  const std::vector<double>& distances_m = content.barrier_distances_m;
  const double one_away_m = distances_m[distance.below(static_cast<std::uint32_t>(distances_m.size()))];
  constexpr std::array<double, 2> two_away_m{.17, .25};
  const Vec2 place = layout.target_places[random.below(static_cast<std::uint32_t>(layout.target_places.size()))];
  const double blocked_side = random.coin() ? 1 : -1;
  SceneObject& target = objects[0];
  target.position_m = place;
  if (layout.shift_m > 0) {
    target.position_m.x += random.uniform(-layout.shift_m, layout.shift_m);
    target.position_m.y += random.uniform(-layout.shift_m, layout.shift_m);
  }
  const auto is_obstacle = [](const SceneObject& object) { return object.role == Role::obstacle; };
  const bool two = std::count_if(objects.begin(), objects.end(), is_obstacle) == 2;
  const auto bar = [&](SceneObject& object, double away_m) {
    object.position_m = {place.x, target.position_m.y + away_m};
    object.yaw_rad = pi / 2;
  };
  std::size_t obstacles = 0;
  double distractor_side = others.coin() ? 1 : -1;
  for (SceneObject& object : objects) {
    if (object.role == Role::obstacle) bar(object, blocked_side * (two ? two_away_m.at(obstacles++) : one_away_m));
    if (object.role != Role::distractor) continue;
    if (!content.choice.empty()) {
      bar(object, -blocked_side * one_away_m);
    } else {
      object.position_m = {Workspace::x_min + Workspace::x_max - place.x, distractor_side * distractor_y_m};
      distractor_side = -distractor_side;
    }
  }
}

}  // namespace

std::vector<std::string> layouts(Task task) {
  std::vector<std::string> ids;
  for (const Layout& layout : all_layouts())
    if (layout.task == task) ids.push_back(layout.id);
  return ids;
}

const Layout& find_layout(Task task, const std::string& id) {
  for (const Layout& layout : all_layouts())
    if (layout.task == task && layout.id == id) return layout;
  throw InputError(
      fmt::format("layout \"{}\": expected one of {} (task {})", id, fmt::join(layouts(task), ", "), to_string(task)));
}

void place(const Layout& layout, const SceneContent& content, std::vector<SceneObject>& objects,
           const Streams& stream) {
  if (layout.task == Task::sweep)
    place_for_sweep(layout, content, objects, stream);
  else if (layout.target_places.empty())
    place_freely(layout, objects, stream);
  else
    place_on_cells(layout, objects, stream("layout"));
}

}  // namespace lgabench::tabletop
