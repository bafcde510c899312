#include <lgabench/cell/reference_actor.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <lgabench/core/hash.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/core/stations.hpp>
#include <lgabench/record/reference_rows.hpp>

namespace lgabench {
namespace {

Move oracle(const Environment& environment, const Given&) { return environment.expert_action(); }

using Instances = std::vector<Instance>;

// What can be seen and taken.
Instances visible(const Given& given) {
  const SceneObject* goal = given.scene.find(role::goal);
  Instances all;
  for (const Instance& instance : given.observation().instances)
    if (instance.pixels > 0 && !(goal && instance.id == goal->instance_id)) all.push_back(instance);
  if (all.empty()) throw MethodError("no object is visible");
  return all;
}

// One of them, drawn from the row's stream.
Instance drawn(const Instances& some, const std::string& row, const Scene& scene) {
  RandomStream stream(fmt::format("{}/{}", row, hex(scene.hash())));
  return some[stream.below(static_cast<std::uint32_t>(some.size()))];
}

// Handles it as the oracle would.
Action any_of(const Instances& some, const char* row, const Environment& environment, const Scene& scene) {
  return environment.expert_action_for(drawn(some, row, scene).id);
}

Move random_object(const Environment& environment, const Given& given) {
  return any_of(visible(given), "random_object", environment, given.scene);
}

Move most_shared(const Environment& environment, const Given& given) {
  const Instances all = visible(given);
  int most = 0;
  Instances some;
  for (const Instance& one : all) {
    int shared = 0;
    for (const Instance& other : all) shared += (other.object_type == one.object_type) + (other.texture == one.texture);
    if (shared > most) some.clear();
    if (shared >= most) some.push_back(one);
    most = std::max(most, shared);
  }
  return any_of(some, "most_shared", environment, given.scene);
}

using Pairs = std::set<std::pair<std::string, std::string>>;  // of types and textures

Actor never_demonstrated(const DemonstratedScenes& demonstrated) {
  Pairs shown;
  for (const Scene& scene : demonstrated.scenes)
    for (const SceneObject& o : scene.objects)
      if (o.role == role::target) shown.emplace(o.object_type, o.texture);
  return {[shown](const Environment& environment, const Given& given) {
    const Instances all = visible(given);
    Instances some;
    std::copy_if(all.begin(), all.end(), std::back_inserter(some), [&shown](const Instance& one) {
      return shown.count({one.object_type, one.texture}) == 0;
    });
    return Move(any_of(some.empty() ? all : some, "never_demonstrated", environment, given.scene));
  }};
}

// How often demonstrations took, or led to, objects of a type and of a texture.
struct Counts {
  std::map<std::string, int> types, textures;

  void add(const SceneObject& object) {
    ++types[object.object_type];
    ++textures[object.texture];
  }
  double score(const Instance& one) const {
    const auto times = [](const std::map<std::string, int>& counts, const std::string& name) {
      const auto found = counts.find(name);
      return (found == counts.end() ? 0 : found->second) + .5;
    };
    return times(types, one.object_type) * times(textures, one.texture);
  }
};

struct Demonstrated {
  Counts taken, received;

  void add(const Scene& scene, const Role& second) {
    if (const SceneObject* target = scene.find(role::target)) taken.add(*target);  // the one that the oracle takes
    if (const SceneObject* receiver = scene.find(second)) received.add(*receiver);
  }
};

enum class Extreme { most, least };

// Those of the highest score, or of the lowest.
Instances extreme(const Instances& all, const Counts& counts, Extreme which) {
  std::map<double, Instances> by_score;
  for (const Instance& one : all) by_score[counts.score(one)].push_back(one);
  return which == Extreme::most ? by_score.rbegin()->second : by_score.begin()->second;
}

Actor by_demonstrations(const std::string& row, Extreme which, const DemonstratedScenes& shown) {
  Demonstrated all;
  std::map<int, Demonstrated> of_command;
  for (const Scene& scene : shown.scenes) {
    all.add(scene, shown.second);
    if (which == Extreme::most) of_command[scene.command].add(scene, shown.second);
  }
  return {[=](const Environment& environment, const Given& given) {
    const Scene& scene = given.scene;
    const auto of_its_own = of_command.find(scene.command);
    const Demonstrated& demonstrated = of_its_own == of_command.end() ? all : of_its_own->second;
    Instances seen = visible(given);
    const Instance object = drawn(extreme(seen, demonstrated.taken, which), row, scene);
    Action action = environment.expert_action_for(object.id);
    seen.erase(std::remove_if(seen.begin(), seen.end(), [&](const Instance& one) { return one.id == object.id; }),
               seen.end());
    if (shown.actions.stations.all.empty() || shown.second.empty() || seen.empty()) return Move(action);
    const Instance receiver = drawn(extreme(seen, demonstrated.received, which), row + "/" + shown.second, scene);
    if (const auto at = seen_at(shown.actions, given.observation(), receiver.id)) {
      const Stations& stations = shown.actions.stations;
      action = led_to(stations, nearest_station(stations, *at), std::move(action));
    }
    return Move(action);
  }};
}

}  // namespace

Actor reference_actor(const std::string& id, const DemonstratedScenes& shown) {
  if (id == "oracle") return {oracle};
  if (id == "random_object") return {random_object};
  if (id == "most_shared") return {most_shared};
  if (id == "never_demonstrated") return never_demonstrated(shown);
  if (id == "most_demonstrated") return by_demonstrations(id, Extreme::most, shown);
  if (id == "least_demonstrated") return by_demonstrations(id, Extreme::least, shown);
  std::vector<std::string> known;
  for (const ReferenceRow& row : reference_rows()) known.push_back(row.id);
  throw InputError(fmt::format("reference row \"{}\": expected {}", id, fmt::join(known, ", ")));
}

}  // namespace lgabench
