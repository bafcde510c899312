#include <tabletop/sampler.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include <lgabench/core/random.hpp>
#include <tabletop/objects.hpp>

namespace lgabench::tabletop {
namespace {

constexpr double margin_m = 0.02;  // between outlines
constexpr const char* goal_texture = "wooden";

// Where objects of a task may stand. Without places: anywhere, at any yaw.
struct Layout {
  Task task;
  std::string id;
  std::vector<Vec2> target_places, distractor_places;
  std::optional<Vec2> pallet = {};
  double widest_m = unbounded, widest_target_m = unbounded;
  double shift_m = 0;  // sweep: the target stands up to this far from its place
  static constexpr double unbounded = std::numeric_limits<double>::infinity();
};

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

const Layout& find_layout(Task task, const std::string& id) {
  for (const Layout& layout : all_layouts())
    if (layout.task == task && layout.id == id) return layout;
  throw InputError(
      fmt::format("layout \"{}\": expected one of {} has: {}", id, to_string(task), fmt::join(layouts(task), ", ")));
}

// A second pallet would be a second goal.
bool can_show(const std::string& type, double widest_m) {
  if (type == goal_type) return false;
  const Vec2 size = object_model(type).size_m;
  return std::max(size.x, size.y) <= widest_m + 1e-9;
}

const std::string& any_of(const std::vector<std::string>& names, RandomStream& random) {
  return names[random.below(static_cast<std::uint32_t>(names.size()))];
}

struct Features {
  std::string type, texture;
};

// Uniform over what of the distribution can be shown. `whom` is named in errors.
Features sample_features(const Scenario& scenario, const Layout& layout, const FeatureSet& distribution,
                         double widest_m, const char* whom, RandomStream random) {
  std::vector<std::string> types;
  std::copy_if(distribution.object_types.begin(), distribution.object_types.end(), std::back_inserter(types),
               [&](const std::string& type) { return can_show(type, widest_m); });
  if (types.empty() || distribution.textures.empty())
    throw InputError(
        fmt::format("scenario \"{}\", layout {}: expected a distribution with {} that can be shown, got {}",
                    scenario.id, layout.id, whom, canonical(to_json(distribution))));
  const std::string& type = any_of(types, random);
  return {type, any_of(distribution.textures, random)};
}

bool is_letter(const std::string& type) { return type.rfind("letter ", 0) == 0; }

// Types and textures (as indices of the space's) that belong to none of the sets.
std::vector<std::pair<std::size_t, std::size_t>> outside(const FeatureSpace& space,
                                                         const std::vector<const FeatureSet*>& sets,
                                                         const std::vector<bool>& type_allowed) {
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  std::vector<std::vector<bool>> in_textures;  // of each set
  for (const FeatureSet* set : sets) {
    in_textures.emplace_back();
    for (const std::string& texture : space.textures) in_textures.back().push_back(has(set->textures, texture));
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t type = 0; type < space.object_types.size(); ++type) {
    if (!type_allowed[type]) continue;
    std::vector<bool> taken(space.textures.size());
    for (std::size_t s = 0; s < sets.size(); ++s)
      if (has(sets[s]->object_types, space.object_types[type]))
        for (std::size_t t = 0; t < taken.size(); ++t) taken[t] = taken[t] || in_textures[s][t];
    for (std::size_t t = 0; t < taken.size(); ++t)
      if (!taken[t]) pairs.emplace_back(type, t);
  }
  return pairs;
}

// PROTOCOL, section 3: objects that don't satisfy the command.
std::vector<Features> sample_distractors(const Scenario& scenario, const Layout& layout, const Selection& distribution,
                                         bool training, const std::string& target_type, RandomStream random) {
  const FeatureSpace& space = scenario.space;
  std::vector<const FeatureSet*> excluded{&distribution.target};
  if (distribution.avoid) excluded.push_back(&*distribution.avoid);
  if (!training && scenario.never_distractor) excluded.push_back(&*scenario.never_distractor);

  // Where the earliest letter is asked for, a later one may stand beside it, never an earlier one or the same.
  const bool earliest = scenario.earliest_letter && is_letter(target_type);
  std::vector<std::string> later_letters;
  std::vector<bool> allowed;
  for (const std::string& type : space.object_types) {
    const bool later = is_letter(type) && type > target_type, shown = can_show(type, layout.widest_m);
    allowed.push_back(shown && (!earliest || !is_letter(type) || later));
    if (earliest && shown && later) later_letters.push_back(type);
  }
  const auto others = outside(space, excluded, allowed);

  const std::uint32_t count = training ? 1 : 1 + random.below(2);
  std::vector<Features> distractors;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!later_letters.empty() && random.coin()) {
      const std::string& type = any_of(later_letters, random);
      distractors.push_back({type, any_of(space.textures, random)});
    } else if (!others.empty()) {
      const auto [type, texture] = others[random.below(static_cast<std::uint32_t>(others.size()))];
      distractors.push_back({space.object_types[type], space.textures[texture]});
    }
  }
  return distractors;
}

using Streams = std::function<RandomStream(const std::string& purpose)>;

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

// Uniform place and yaw, kept where it leaves the margin to all that stands: gives the outline there, or nothing.
std::vector<Polygon> try_place(SceneObject& object, const std::vector<std::vector<Polygon>>& standing,
                               RandomStream& random) {
  object.position_m.x = random.uniform(Workspace::x_min, Workspace::x_max);
  object.position_m.y = random.uniform(Workspace::y_min, Workspace::y_max);
  object.yaw_rad = random.uniform(-pi, pi);
  auto outline = placed_outline(object_model(object.object_type), object.position_m, object.yaw_rad);
  if (!inside_picture(outline)) return {};
  for (const auto& other : standing)
    if (distance(outline, other) < margin_m) return {};
  return outline;
}

bool place_distractors(std::vector<SceneObject>& objects, std::vector<std::vector<Polygon>> standing,
                       RandomStream& random) {
  constexpr int tries = 200;
  for (std::size_t i = 1; i < objects.size(); ++i) {
    std::vector<Polygon> outline;
    for (int k = 0; k < tries && outline.empty(); ++k) outline = try_place(objects[i], standing, random);
    if (outline.empty()) return false;
    standing.push_back(std::move(outline));
  }
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

void place_freely(const Layout& layout, std::vector<SceneObject>& objects, const Streams& stream) {
  constexpr int tries = 10000;
  RandomStream random = stream("layout"), others = stream("layout of distractors");
  std::vector<std::vector<Polygon>> standing;
  if (layout.pallet) standing.push_back(placed_outline(object_model(goal_type), *layout.pallet, 0));
  for (int k = 0; k < tries; ++k) {
    auto outline = try_place(objects[0], standing, random);
    if (outline.empty()) continue;
    auto room = room_for_motion(layout, objects[0]);
    if (!inside_picture(room)) continue;
    auto with_target = standing;
    with_target.push_back(std::move(outline));
    with_target.push_back(std::move(room));
    if (place_distractors(objects, std::move(with_target), others)) return;
  }
  throw Error(fmt::format("layout {}: no room found for {} objects in {} tries", layout.id, objects.size(), tries));
}

// PROTOCOL, section 3: the obstacle bars one side of the target's row, distractors stand in the other row.
void place_for_sweep(const Layout& layout, std::vector<SceneObject>& objects, RandomStream random,
                     RandomStream others) {
  constexpr double obstacle_away_m = .21, distractor_y_m = .16;
  const Vec2 place = layout.target_places[random.below(static_cast<std::uint32_t>(layout.target_places.size()))];
  const double blocked_side = random.coin() ? 1 : -1;
  SceneObject& target = objects[0];
  target.position_m = place;
  if (layout.shift_m > 0) {
    target.position_m.x += random.uniform(-layout.shift_m, layout.shift_m);
    target.position_m.y += random.uniform(-layout.shift_m, layout.shift_m);
  }
  double distractor_side = others.coin() ? 1 : -1;
  for (SceneObject& object : objects) {
    if (object.role == Role::obstacle) {
      object.position_m = {place.x, target.position_m.y + blocked_side * obstacle_away_m};
      object.yaw_rad = pi / 2;
    }
    if (object.role == Role::distractor) {
      object.position_m = {Workspace::x_min + Workspace::x_max - place.x, distractor_side * distractor_y_m};
      distractor_side = -distractor_side;
    }
  }
}

// Ids 1..n in random order, the objects sorted by them: neither tells a role.
void permute_ids(std::vector<SceneObject>& objects, RandomStream random) {
  const auto order = random.permutation(static_cast<int>(objects.size()));
  for (std::size_t i = 0; i < objects.size(); ++i) objects[i].instance_id = static_cast<std::uint8_t>(order[i] + 1);
  std::sort(objects.begin(), objects.end(), [](const auto& a, const auto& b) { return a.instance_id < b.instance_id; });
}

void check(const Scenario& scenario, const SceneRequest& request, int index) {
  const auto& split = request.split;
  if (split != "train" && split != "dev" && split != "test")
    throw InputError(fmt::format("split \"{}\": expected train, dev or test", split));
  const auto is_asked = [&](const Arm& arm) { return arm.id == request.arm; };
  if (request.arm != "train" && std::none_of(scenario.tests.begin(), scenario.tests.end(), is_asked))
    throw InputError(
        fmt::format("arm \"{}\": expected train or a test arm of scenario \"{}\"", request.arm, scenario.id));
  if (index < 0) throw InputError(fmt::format("scene index {}: expected 0 or more", index));
}

}  // namespace

std::vector<std::string> layouts(Task task) {
  std::vector<std::string> ids;
  for (const Layout& layout : all_layouts())
    if (layout.task == task) ids.push_back(layout.id);
  return ids;
}

Scene sample_scene(const Scenario& scenario, const SceneRequest& request, int index) {
  check(scenario, request, index);
  const Layout& layout = find_layout(scenario.command.task, request.layout);
  const bool training = request.arm == "train";
  const Selection& distribution = training ? request.distribution : scenario.truth;
  // Arms share their streams: they are compared scene by scene.
  const Streams stream = [&](const std::string& purpose) {
    return RandomStream(fmt::format("scene/{}/{}/{}/{}/{}/{}", scenario.id, request.layout, request.split, request.seed,
                                    index, purpose));
  };

  const Features target =
      sample_features(scenario, layout, distribution.target, std::min(layout.widest_m, layout.widest_target_m),
                      "a target", stream("target"));
  std::vector<SceneObject> objects{{target.type, target.texture, Role::target, {}, 0, 0}};
  for (const Features& d :
       sample_distractors(scenario, layout, distribution, training, target.type, stream("distractors")))
    objects.push_back({d.type, d.texture, Role::distractor, {}, 0, 0});
  if (scenario.command.task == Task::sweep) {
    const Features obstacle = sample_features(scenario, layout, distribution.avoid.value_or(FeatureSet{}),
                                              layout.widest_m, "an obstacle", stream("obstacle"));
    objects.push_back({obstacle.type, obstacle.texture, Role::obstacle, {}, 0, 0});
  }

  if (scenario.command.task == Task::sweep)
    place_for_sweep(layout, objects, stream("layout"), stream("layout of distractors"));
  else if (layout.target_places.empty())
    place_freely(layout, objects, stream);
  else
    place_on_cells(layout, objects, stream("layout"));
  if (layout.pallet) objects.push_back({goal_type, goal_texture, Role::goal, *layout.pallet, 0, 0});
  permute_ids(objects, stream("ids"));

  Scene scene{scenario.id, request.arm, request.layout, request.split, scenario.command.task, 0, request.seed,
              index,       {}};
  scene.angle_rad = scenario.angle_deg * pi / 180;
  scene.objects = std::move(objects);
  return scene;
}

}  // namespace lgabench::tabletop
