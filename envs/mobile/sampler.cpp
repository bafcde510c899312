#include <mobile/sampler.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <tuple>

#include <common/changed.hpp>
#include <common/objects.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/sampling.hpp>
#include <mobile/content.hpp>
#include <mobile/place.hpp>
#include <mobile/receivers.hpp>
#include <mobile/renderer.hpp>
#include <mobile/tables.hpp>

#include <lgabench/core/contains.hpp>

namespace lgabench::mobile {
namespace {

constexpr double margin_m = .02;                                // between outlines
constexpr double nearest_first_m = .1, farthest_first_m = .25;  // see Content::near_first

using Names = std::vector<std::string>;

// A texture that things of the type have in life; of those, one that the distribution holds, if there is one.
std::string natural_texture(const std::string& type, const Names& held, RandomStream& random) {
  const Names& natural = natural_textures().at(type);
  Names both;
  std::copy_if(natural.begin(), natural.end(), std::back_inserter(both),
               [&](const auto& t) { return contains(held, t); });
  return any_of(both.empty() ? held : both, random);
}

// Those that scenes can show.
Names showable(const Names& types) {
  Names kept;
  std::copy_if(types.begin(), types.end(), std::back_inserter(kept),
               [](const std::string& type) { return natural_textures().count(type) > 0; });
  return kept;
}

// The target of the first training scene.
struct First {
  std::string type;
  Vec2 position_m;
};

SceneObject sample_target(const Scenario& scenario, const FeatureSet& meant, const std::optional<First>& first,
                          RandomStream random) {
  Names types = showable(meant.object_types);
  if (types.empty() || meant.textures.empty())
    throw NothingToShow(fmt::format("scenario \"{}\": expected a distribution with a target that can be shown, got {}",
                                    scenario.id, canonical(to_json(meant))));
  if (first && types.size() > 1) types.erase(std::remove(types.begin(), types.end(), first->type), types.end());
  const std::string type = any_of(types, random);
  return {type, natural_texture(type, meant.textures, random), role::target, {}, 0, 0};
}

std::vector<SceneObject> sample_others(const Content& content, const FeatureSet& truth, const FeatureSpace& space,
                                       RandomStream random) {
  Names types = content.distractor_types;
  if (content.several_right)
    for (const std::string& type : showable(truth.object_types)) types.push_back(type);
  const auto [fewest, most] = content.distractors;
  const int count = fewest + static_cast<int>(random.below(static_cast<std::uint32_t>(most - fewest + 1)));
  std::vector<SceneObject> others;
  for (int i = 0; i < count; ++i) {
    const std::string type = any_of(types, random);
    const std::string texture = natural_texture(type, space.textures, random);
    others.push_back({type, texture, truth.contains(type, texture) ? role::target : role::distractor, {}, 0, 0});
  }
  return others;
}

std::vector<Polygon> outline_of(const SceneObject& o) { return placed_outline(model_of(o), o.position_m, o.yaw_rad); }

void place_anywhere(SceneObject& object, RandomStream& random) {
  object.position_m.x = random.uniform(zone.low.x, zone.high.x);
  object.position_m.y = random.uniform(zone.low.y, zone.high.y);
  object.yaw_rad = random.uniform(-pi, pi);
}

// Share of the first object's pixels that the others leave visible.
double visible_share(const std::vector<SceneObject>& objects) {
  static thread_local Renderer renderer(front_camera());
  Scene scene;
  scene.objects = objects;
  for (std::size_t i = 0; i < objects.size(); ++i) scene.objects[i].instance_id = static_cast<std::uint8_t>(i + 1);
  const auto pixels = [&] {
    const auto ids = renderer.ids(visible_objects(scene));
    return static_cast<double>(std::count(ids.begin(), ids.end(), 1));
  };
  const double with_others = pixels();
  scene.objects.resize(1);
  return with_others / pixels();
}

// Places for all but the first; false where none are found.
bool place_others(std::vector<SceneObject>& objects, RandomStream& random) {
  constexpr int tries = 300;
  std::vector<std::vector<Polygon>> taken{outline_of(objects[0])};
  for (std::size_t i = 1; i < objects.size(); ++i) {
    bool free = false;
    for (int k = 0; k < tries && !free; ++k) {
      place_anywhere(objects[i], random);
      const auto outline = outline_of(objects[i]);
      free = std::all_of(taken.begin(), taken.end(), [&](const auto& o) { return distance(o, outline) >= margin_m; });
      if (free) taken.push_back(outline);
    }
    if (!free) return false;
  }
  return true;
}

void place(const Content& content, const std::optional<First>& first, std::vector<SceneObject>& objects,
           const Streams& stream) {
  constexpr int targets = 1000, tries = 100;
  RandomStream random = stream("layout"), others = stream("layout of distractors");
  for (int k = 0; k < targets; ++k) {
    place_anywhere(objects[0], random);
    if (first) {
      const double away = norm(objects[0].position_m - first->position_m);
      if (away < nearest_first_m || away > farthest_first_m) {
        --k;  // the ring covers a part of the zone that is never empty
        continue;
      }
    }
    for (int i = 0; i < tries; ++i)
      if (place_others(objects, others) && (objects.size() == 1 || visible_share(objects) >= content.least_visible))
        return;
  }
  throw Error(fmt::format("no room found for {} objects", objects.size()));
}

// A place for the last.
bool place_last(std::vector<SceneObject>& objects, RandomStream& random) {
  constexpr int tries = 100;
  for (int k = 0; k < tries; ++k) {
    place_anywhere(objects.back(), random);
    if (has_room(objects, objects.size() - 1, margin_m)) return true;
  }
  return false;
}

}  // namespace

bool has_room(const std::vector<SceneObject>& objects, std::size_t i, double margin_m) {
  const std::vector<Polygon> outline = outline_of(objects[i]);
  for (const Polygon& polygon : outline)
    if (!std::all_of(polygon.begin(), polygon.end(), [](Vec2 corner) { return table.contains(corner); })) return false;
  for (std::size_t k = 0; k < objects.size(); ++k)
    if (k != i && distance(outline_of(objects[k]), outline) < margin_m) return false;
  return true;
}

Scene with_distractors(const Scenario& scenario, const Scene& scene, int count, bool near_miss, RandomStream random) {
  const Content& content = content_of(scenario, scene.arm);
  const FeatureSet& truth = scenario.commands[static_cast<std::size_t>(scene.command)].truth.target.product();
  const auto draw = [&](const std::vector<SceneObject>& objects, int) -> std::optional<SceneObject> {
    const SceneObject& target = objects.front();
    std::vector<std::pair<std::string, std::string>> near;
    for (const auto& [type, textures] : natural_textures())
      for (const std::string& texture : textures)
        if ((type == target.object_type) != (texture == target.texture) && !truth.contains(type, texture))
          near.emplace_back(type, texture);
    SceneObject one{"", "", role::distractor, {}, 0, 0};
    if (near_miss && !near.empty()) {
      std::tie(one.object_type, one.texture) = near[random.below(static_cast<std::uint32_t>(near.size()))];
    } else {
      one.object_type = any_of(content.distractor_types, random);
      one.texture = natural_texture(one.object_type, scenario.space.textures, random);
      if (truth.contains(one.object_type, one.texture)) return std::nullopt;
    }
    return one;
  };
  const auto place = [&](std::vector<SceneObject>& objects) {
    return place_last(objects, random) && visible_share(objects) >= content.least_visible;
  };
  return with_more(scene, count, random, {draw, place});
}

Scene sample_scene(const Scenario& scenario, const SceneRequest& request, int index) {
  if (request.layout != layout) throw InputError(fmt::format("layout \"{}\": expected {}", request.layout, layout));
  Scene scene = without_objects(scenario, request, index);
  const auto command = static_cast<std::size_t>(scene.command);
  const FeatureSet& truth = scenario.commands[command].truth.target.product();
  const Content& content = content_of(scenario, request.arm);
  const bool asked = request.arm == "train" && scenario.as_method_asks && !request.selections.empty();
  const Streams stream = streams_of(scenario, request, index);
  std::optional<First> first;
  if (content.near_first) {
    const Scene shown = sample_scene(scenario, {layout, "train", "train", request.training_seed.value_or(0)}, 0);
    const SceneObject* target = shown.find(role::target);
    first = First{target->object_type, target->position_m};
  }

  scene.objects = {sample_target(scenario, asked ? request.selections.at(command).target.product() : truth, first,
                                 stream("target"))};
  for (SceneObject& other : sample_others(content, truth, scenario.space, stream("distractors")))
    scene.objects.push_back(std::move(other));
  place(content, first, scene.objects, stream);
  permute_ids(scene.objects, stream("ids"));
  return scene;
}

}  // namespace lgabench::mobile
