#include <mobile/fetch.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <common/changed.hpp>
#include <common/objects.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/sampling.hpp>
#include <mobile/content.hpp>
#include <mobile/mobile.hpp>
#include <mobile/near_misses.hpp>
#include <mobile/receivers.hpp>
#include <mobile/renderer.hpp>
#include <mobile/sampler.hpp>

namespace lgabench::mobile {
namespace {

constexpr double apart_m = .02;                // between outlines
constexpr double least_receiver_visible = .6;  // share of a receiver's pixels
constexpr int receivers_shown = 3;
// Outlines of objects stay within: on the table, and clear of the receivers.
constexpr Rectangle room{{.605, -.58}, {1.04, .58}};

Features sample_one(const Scenario& scenario, const std::vector<Features>& all, const FeatureSet& meant,
                    const char* whom, RandomStream random) {
  const std::vector<Features> some = held(all, meant);
  if (some.empty())
    throw NothingToShow(fmt::format("scenario \"{}\": expected a distribution with a {} that can be shown, got {}",
                                    scenario.id, whom, canonical(to_json(meant))));
  return one_of(some, random);
}

// Those that neither the command nor what is asked for holds.
std::vector<Features> wrong(const std::vector<Features>& all, const FeatureSet& truth, const FeatureSet& meant) {
  std::vector<Features> kept;
  for (const Features& f : all)
    if (!truth.contains(f.type, f.texture) && !meant.contains(f.type, f.texture)) kept.push_back(f);
  return kept;
}

std::vector<Polygon> outline_at(const SceneObject& o) { return placed_outline(model_of(o), o.position_m, o.yaw_rad); }

bool within_room(const std::vector<Polygon>& outline) {
  return std::all_of(outline.begin(), outline.end(), [](const Polygon& p) {
    return std::all_of(p.begin(), p.end(), [](Vec2 corner) { return room.contains(corner); });
  });
}

// A place within the room, apart from what has been placed; false where there is none.
bool place_one(SceneObject& object, std::vector<std::vector<Polygon>>& taken, RandomStream& random) {
  constexpr int tries = 300;
  for (int i = 0; i < tries; ++i) {
    object.position_m = {random.uniform(fetch_zone.low.x, fetch_zone.high.x),
                         random.uniform(fetch_zone.low.y, fetch_zone.high.y)};
    object.yaw_rad = random.uniform(-pi, pi);
    auto outline = outline_at(object);
    if (!within_room(outline)) continue;
    if (std::any_of(taken.begin(), taken.end(), [&](const auto& o) { return distance(o, outline) < apart_m; }))
      continue;
    taken.push_back(std::move(outline));
    return true;
  }
  return false;
}

// The first object and every receiver are seen well enough behind the others.
bool seen_well(const std::vector<SceneObject>& objects, double least_visible) {
  static thread_local Renderer renderer(front_camera());
  Scene all;
  all.objects = objects;
  for (std::size_t i = 0; i < objects.size(); ++i) all.objects[i].instance_id = static_cast<std::uint8_t>(i + 1);
  Scene alone = all, receivers = all;
  alone.objects.resize(1);
  receivers.objects.erase(std::remove_if(receivers.objects.begin(), receivers.objects.end(),
                                         [](const SceneObject& o) { return !is_receiver(o.object_type); }),
                          receivers.objects.end());
  const auto pixels = [](const Scene& scene) {
    std::vector<double> counts(most_fetch_objects + 1);
    for (const std::uint8_t id : renderer.ids(visible_objects(scene))) ++counts[id];
    return counts;
  };
  const std::vector<double> of_all = pixels(all), of_target = pixels(alone), of_receivers = pixels(receivers);
  if (of_all[1] < least_visible * of_target[1]) return false;
  return std::all_of(receivers.objects.begin(), receivers.objects.end(), [&](const SceneObject& o) {
    return of_all[o.instance_id] >= least_receiver_visible * of_receivers[o.instance_id];
  });
}

// Places for the first object, which is the target, and then the others; receivers stand at their stations.
void place(std::vector<SceneObject>& objects, double least_visible, const Streams& stream) {
  constexpr int targets = 200, tries = 20;
  RandomStream random = stream("layout"), others = stream("layout of distractors");
  for (int k = 0; k < targets; ++k) {
    std::vector<std::vector<Polygon>> target;
    if (!place_one(objects[0], target, random)) continue;
    for (int i = 0; i < tries; ++i) {
      auto taken = target;
      bool fits = true;
      for (std::size_t o = 1; o < objects.size() && fits; ++o)
        fits = is_receiver(objects[o].object_type) || place_one(objects[o], taken, others);
      if (fits && seen_well(objects, least_visible)) return;
    }
  }
  throw Error(fmt::format("no room found for {} objects", objects.size()));
}

}  // namespace

std::vector<std::string> fetch_scene_members() {
  return {"distractors", "near_miss", "least_visible", "caption_error"};
}

FetchContent read_fetch_content(const Scenario& scenario, const JsonReader* scenes, bool training) {
  static_assert(most_fetch_others == most_fetch_objects - receivers_shown - 1);
  FetchContent content;
  if (training) content.distractors = {1, 1};
  if (!scenes) return content;
  if (scenes->has("distractors")) content.distractors = read_distractors(scenes->at("distractors"), most_fetch_others);
  if (scenes->has("near_miss") && scenes->at("near_miss").json() != Json(false)) {
    const JsonReader reader = scenes->at("near_miss");
    content.near_miss = read_near_miss(reader, scenario);
    if (content.near_miss->size_matched) reader.at("size").fail("no such member in this environment");
    if (training && scenario.as_method_asks)  // else an answer would decide what is near
      reader.fail("\"as_method_asks\": false beside it");
  }
  if (scenes->has("least_visible")) content.least_visible = read_share(scenes->at("least_visible"));
  if (scenes->has("caption_error")) {
    if (training) scenes->at("caption_error").fail("no such member in \"train\"");
    content.caption_error = read_share(scenes->at("caption_error"));
  }
  return content;
}

Scene sample_fetch(const Scenario& scenario, const SceneRequest& request, int index) {
  if (request.layout != layout) throw InputError(fmt::format("layout \"{}\": expected {}", request.layout, layout));
  Scene scene = without_objects(scenario, request, index);
  const auto command = static_cast<std::size_t>(scene.command);
  const bool training = request.arm == "train";
  const auto& content =
      dynamic_cast<const FetchContent&>(training ? *scenario.train : *scenario.arm(request.arm).scenes);
  const Selection& truth = scenario.commands[command].truth;
  const bool asked = training && scenario.as_method_asks && !request.selections.empty();
  const Selection& meant = asked ? request.selections.at(command) : truth;
  const Streams stream = streams_of(scenario, request, index);
  if (!meant.second)
    throw NothingToShow(fmt::format("scenario \"{}\": expected a distribution with a second set", scenario.id));

  const Features target = sample_one(scenario, natural_objects(), meant.target.product(), "target", stream("target"));
  const Features goal = sample_one(scenario, natural_receivers(), *meant.second, receiver, stream(receiver));
  const std::vector<Features> may_be = wrong(natural_objects(), truth.target.product(), meant.target.product()),
                              may_receive = wrong(natural_receivers(), *truth.second, *meant.second);
  RandomStream random = stream("distractors"), of_receivers = stream("receivers");
  for (const auto& [some, whom] : {std::pair{&may_be, "object"}, std::pair{&may_receive, receiver}})
    if (some->empty())
      throw NothingToShow(
          fmt::format("scenario \"{}\": expected a command that leaves out some {}", scenario.id, whom));
  const auto [fewest, most] = content.distractors;
  const int count = fewest + static_cast<int>(random.below(static_cast<std::uint32_t>(most - fewest + 1)));
  std::vector<Features> others, receivers;
  if (content.near_miss) {
    others = near_others(may_be, target, truth.target.product(), *content.near_miss, count, random);
    receivers = near_receivers(may_receive, goal, of_receivers);
  } else {
    others = uniform_others(may_be, count, random);
    receivers = uniform_others(may_receive, receivers_shown - 1, of_receivers);
  }

  scene.objects = {{target.type, target.texture, role::target, {}, 0, 0}};
  for (const Features& other : others) scene.objects.push_back({other.type, other.texture, role::distractor, {}, 0, 0});
  receivers.insert(receivers.begin(), goal);
  const std::vector<int> stood = stream("stations").permutation(static_cast<int>(stations.size()));
  for (std::size_t i = 0; i < receivers.size(); ++i)
    scene.objects.push_back({receivers[i].type, receivers[i].texture, i == 0 ? receiver : role::distractor,
                             stations[static_cast<std::size_t>(stood[i])], 0, 0});
  place(scene.objects, content.least_visible, stream);
  permute_ids(scene.objects, stream("ids"));
  return scene;
}

Scene fetch_with_distractors(const Scenario& scenario, const Scene& scene, int count, bool near_miss,
                             RandomStream random) {
  const Selection& truth = scenario.commands[static_cast<std::size_t>(scene.command)].truth;
  const double least_visible = dynamic_cast<const FetchContent&>(*scenario.arm(scene.arm).scenes).least_visible;
  const std::vector<Features> may_be = wrong(natural_objects(), truth.target.product(), truth.target.product());
  const auto draw = [&](const std::vector<SceneObject>& objects, int) -> std::optional<SceneObject> {
    const std::vector<Features> near = like(may_be, {objects.front().object_type, objects.front().texture});
    const auto [type, texture] = one_of(near_miss && !near.empty() ? near : may_be, random);
    return SceneObject{type, texture, role::distractor, {}, 0, 0};
  };
  const auto place = [&](std::vector<SceneObject>& objects) {
    std::vector<std::vector<Polygon>> taken;
    for (std::size_t i = 0; i + 1 < objects.size(); ++i)
      if (!is_receiver(objects[i].object_type)) taken.push_back(outline_at(objects[i]));
    return place_one(objects.back(), taken, random) && seen_well(objects, least_visible);
  };
  return with_more(scene, count, random, {draw, place});
}

}  // namespace lgabench::mobile
