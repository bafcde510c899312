#include <lgabench/plugin/simple_environment.hpp>

#include <fmt/format.h>

#include <algorithm>

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

std::shared_ptr<const SceneContent> SimpleEnvironment::read_content(const Scenario& scenario, const JsonReader& file,
                                                                    const JsonReader* /*scenes*/,
                                                                    bool /*training*/) const {
  for (const ScenarioCommand& command : scenario.commands)
    if (command.truth.target.which || !command.truth.target.turns.empty())
      file.at("commands")
          .fail(fmt::format(
              "sets of objects alone, since environment {} does not say which of several is meant, or in which order",
              id()));
  return std::make_shared<SceneContent>();
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
  for (const int i : stream("others").permutation(static_cast<int>(others.size()))) {
    const Named& other = others[static_cast<std::size_t>(i)];
    const SceneObject& chosen = scene.objects.front();
    if (static_cast<int>(scene.objects.size()) == about_.most_things) break;
    if (other.object_type != chosen.object_type || other.texture != chosen.texture)
      scene.objects.push_back(object_of(other, role::distractor));
  }
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
