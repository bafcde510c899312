#include <lgabench/plugin/simple_environment.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/sampling.hpp>
#include <lgabench/core/suggest.hpp>

namespace lgabench {
namespace {

std::vector<Named> those_of(const Meaning& meaning, const std::vector<Named>& things, bool meant) {
  std::vector<Named> found;
  std::copy_if(things.begin(), things.end(), std::back_inserter(found), [&meaning, meant](const Named& thing) {
    return meaning.belongs(thing.object_type, thing.texture) == meant;
  });
  return found;
}

// What a scenario's file says of an arm's scenes, or of training's.
struct Others : SceneContent {
  std::optional<std::pair<int, int>> count;  // fewest, most
  bool near_first = false;
};

Others others_of(const Scenario& scenario, const std::string& arm) {
  const SceneContent* const scenes = arm == "train" ? scenario.train.get() : scenario.arm(arm).scenes.get();
  const auto* const others = dynamic_cast<const Others*>(scenes);  // not that of a class which reads its own
  return others ? *others : Others();
}

SceneObject object_of(const Named& thing, const Role& role) {
  SceneObject object;
  object.object_type = thing.object_type;
  object.texture = thing.texture;
  object.role = role;
  return object;
}

}  // namespace

Vec2 SimpleEnvironment::in_picture(Vec3 point_m) const {
  const ActionSpace& space = about_.actions;
  if (space.places.empty()) return {about_.picture.columns / 2., about_.picture.rows / 2.};
  const ActionNumber &down = space.numbers[space.places.front().down],
                     &across = space.numbers[space.places.front().across];
  return {(point_m.y - across.low) / (across.high - across.low) * about_.picture.columns,
          (point_m.x - down.low) / (down.high - down.low) * about_.picture.rows};
}

void SimpleEnvironment::expect_sets(const Scenario& scenario, const JsonReader& file) const {
  for (const ScenarioCommand& command : scenario.commands)
    if (command.truth.target.which || !command.truth.target.turns.empty())
      file.at("commands")
          .fail(fmt::format(
              "sets of objects alone, since environment {} does not say which of several is meant, or in which order",
              id()));
}

std::shared_ptr<const SceneContent> SimpleEnvironment::read_content(const Scenario& scenario, const JsonReader& file,
                                                                    const JsonReader* scenes, bool /*training*/) const {
  expect_sets(scenario, file);
  auto others = std::make_shared<Others>();
  if (scenes && scenes->has("near_miss")) others->near_first = scenes->at("near_miss").boolean();
  if (scenes && scenes->has("distractors")) {
    const std::vector<JsonReader> range = scenes->at("distractors").elements();
    if (range.size() != 2) scenes->at("distractors").fail("[fewest, most]");
    const int fewest = static_cast<int>(range[0].integer(0, about_.most_things - 1));
    others->count = {fewest, static_cast<int>(range[1].integer(fewest, about_.most_things - 1))};
  }
  return others;
}

SimpleEnvironment::Things SimpleEnvironment::things_for(const Scenario& scenario, const SceneRequest& request,
                                                        int index) const {
  const std::vector<std::string> layouts = layouts_of(scenario);
  if (!contains(layouts, request.layout)) throw InputError(none_named("layout", request.layout, layouts));
  const auto command = static_cast<std::size_t>(without_objects(scenario, request, index).command);
  const Meaning& truth = scenario.commands[command].truth.target;
  const bool as_asked = request.arm == "train" && scenario.as_method_asks && !request.selections.empty();
  Things things{those_of(as_asked ? request.selections[command].target : truth, about_.things, true),
                those_of(truth, about_.things, false)};
  if (things.meant.empty())
    throw NothingToShow(fmt::format("scenario \"{}\": environment {} has nothing that is meant", scenario.id, id()));
  return things;
}

Scene SimpleEnvironment::sample(const Scenario& scenario, const SceneRequest& request, int index) const {
  const auto [meant, others] = things_for(scenario, request, index);
  Scene scene = without_objects(scenario, request, index);
  const Streams stream = streams_of(scenario, request, index);
  RandomStream target = stream("target");
  scene.objects.push_back(object_of(meant[target.below(static_cast<std::uint32_t>(meant.size()))], role::target));
  const Others arm = others_of(scenario, request.arm);
  const SceneObject chosen = scene.objects.front();
  std::vector<Named> drawn;
  for (const int i : stream("others").permutation(static_cast<int>(others.size()))) {
    const Named& other = others[static_cast<std::size_t>(i)];
    if (other.object_type != chosen.object_type || other.texture != chosen.texture) drawn.push_back(other);
  }
  if (arm.near_first)
    std::stable_partition(drawn.begin(), drawn.end(), [&chosen](const Named& one) {
      return one.object_type == chosen.object_type || one.texture == chosen.texture;
    });
  const auto [fewest, most] = arm.count.value_or(std::pair(about_.most_things - 1, about_.most_things - 1));
  const auto count =
      static_cast<std::size_t>(fewest) + stream("count").below(static_cast<std::uint32_t>(most - fewest + 1));
  if (drawn.size() > count) drawn.resize(count);
  for (const Named& other : drawn) scene.objects.push_back(object_of(other, role::distractor));
  permute_ids(scene.objects, stream("ids"));
  place(scene, stream("places"));
  return scene;
}

Observation SimpleEnvironment::draw(const Scene& scene, const View& /*view*/) const {
  return make(scene.task)->reset(scene);
}

std::unique_ptr<Environment> SimpleEnvironment::make(std::unique_ptr<PhysicsWorld> /*engine*/,
                                                     const Scenario& scenario) const {
  return make(scenario.task);
}

}  // namespace lgabench
