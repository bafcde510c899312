#include <lgabench/cell/reference_actor.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <lgabench/abstraction/committed_embeddings.hpp>
#include <lgabench/abstraction/taken_looks.hpp>
#include <lgabench/cell/constant_action.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/core/stations.hpp>
#include <lgabench/record/reference_rows.hpp>

namespace lgabench {
namespace {

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
  RandomStream stream(fmt::format("{}/{}", row, hex(scene.shared_hash())));
  return some[stream.below(static_cast<std::uint32_t>(some.size()))];
}

Actor oracle(const std::string&, const DemonstratedScenes&) {
  return {[](const Environment& environment, const Given&) { return Move(environment.expert_action()); }};
}

// Takes one of those that `rule` leaves of the visible objects, and handles it as the oracle would.
template <typename Rule>
Actor any_of(const std::string& row, const Rule& rule) {
  return {[row, rule](const Environment& environment, const Given& given) {
    return Move(environment.expert_action_for(drawn(rule(visible(given)), row, given.scene).id));
  }};
}

Actor any_object(const std::string& row, const DemonstratedScenes&) {
  return any_of(row, [](const Instances& all) { return all; });
}

// Takes any visible object, at each step drawn anew, until it stops. Both scenes of a pair have the same draws.
template <typename Stops>
Actor until(const std::string& row, const Stops& stops) {
  return {[row, stops](const Environment& environment, const Given& given) {
    RandomStream stream(fmt::format("{}/{}{}", row, hex(given.scene.shared_hash()), later_stream(given.step)));
    if (stops(given, stream)) return Move(Action());
    const Instances all = visible(given);
    return Move(environment.expert_action_for(all[stream.below(static_cast<std::uint32_t>(all.size()))].id));
  }};
}

Actor stops_at_once(const std::string& row, const DemonstratedScenes&) {
  return until(row, [](const Given&, RandomStream&) { return true; });
}

Actor two_then_stops(const std::string& row, const DemonstratedScenes&) {
  return until(row, [](const Given& given, RandomStream&) { return given.observation().brought.size() >= 2; });
}

Actor stops_at_random(const std::string& row, const DemonstratedScenes&) {
  return until(row, [](const Given&, RandomStream& stream) { return stream.uniform() < .3; });
}

Instances sharing_most(const Instances& all) {
  int most = 0;
  Instances some;
  for (const Instance& one : all) {
    int shared = 0;
    for (const Instance& other : all) shared += (other.object_type == one.object_type) + (other.texture == one.texture);
    if (shared > most) some.clear();
    if (shared >= most) some.push_back(one);
    most = std::max(most, shared);
  }
  return some;
}

Actor most_shared(const std::string& row, const DemonstratedScenes&) { return any_of(row, sharing_most); }

using Pairs = std::set<std::pair<std::string, std::string>>;  // of types and textures

Actor never_demonstrated(const std::string& row, const DemonstratedScenes& demonstrated) {
  Pairs shown;
  for (const Scene& scene : demonstrated.scenes)
    for (const SceneObject& o : scene.objects)
      if (o.role == role::target) shown.emplace(o.object_type, o.texture);
  return any_of(row, [shown](const Instances& all) {
    Instances some;
    std::copy_if(all.begin(), all.end(), std::back_inserter(some), [&shown](const Instance& one) {
      return shown.count({one.object_type, one.texture}) == 0;
    });
    return some.empty() ? all : some;
  });
}

// What demonstrations took, and what they led to.
struct Demonstrated {
  TakenLooks taken, received;

  void add(const Scene& scene, const Role& second) {
    if (const SceneObject* target = scene.find(role::target)) add(taken, *target);  // the one that the oracle takes
    if (const SceneObject* receiver = scene.find(second)) add(received, *receiver);
  }

 private:
  static void add(TakenLooks& to, const SceneObject& object) {
    to.objects.emplace_back(object.object_type, object.texture);
  }
};

using Score = std::function<double(const Instance& one, const TakenLooks& taken)>;

double counted(const Instance& one, const TakenLooks& taken) { return taken.counted(one); }

// Those of the highest score.
Instances likest(const Instances& all, const TakenLooks& taken, const Score& score) {
  std::map<double, Instances> by_score;
  for (const Instance& one : all) by_score[score(one, taken)].push_back(one);
  return by_score.rbegin()->second;
}

enum class Counting { of_its_command, of_all };

Actor by_demonstrations(const std::string& row, const Score& score, Counting counting,
                        const DemonstratedScenes& shown) {
  Demonstrated all;
  std::map<int, Demonstrated> of_command;
  for (const Scene& scene : shown.scenes) {
    all.add(scene, shown.second);
    if (counting == Counting::of_its_command) of_command[scene.command].add(scene, shown.second);
  }
  return {[=](const Environment& environment, const Given& given) {
    const Scene& scene = given.scene;
    const auto of_its_own = of_command.find(scene.command);
    const Demonstrated& demonstrated = of_its_own == of_command.end() ? all : of_its_own->second;
    Instances seen = visible(given);
    const Instance object = drawn(likest(seen, demonstrated.taken, score), row, scene);
    Action action = environment.expert_action_for(object.id);
    seen.erase(std::remove_if(seen.begin(), seen.end(), [&](const Instance& one) { return one.id == object.id; }),
               seen.end());
    if (shown.actions.stations.all.empty() || shown.second.empty() || seen.empty()) return Move(action);
    const Instance receiver = drawn(likest(seen, demonstrated.received, score), row + "/" + shown.second, scene);
    if (const auto at = seen_at(shown.actions, given.observation(), receiver.id)) {
      const Stations& stations = shown.actions.stations;
      action = led_to(stations, nearest_station(stations, *at), std::move(action));
    }
    return Move(action);
  }};
}

Actor most_demonstrated(const std::string& row, const DemonstratedScenes& shown) {
  return by_demonstrations(row, counted, Counting::of_its_command, shown);
}

Actor least_demonstrated(const std::string& row, const DemonstratedScenes& shown) {
  const Score least = [](const Instance& one, const TakenLooks& taken) { return -taken.counted(one); };
  return by_demonstrations(row, least, Counting::of_all, shown);
}

Actor most_alike_names(const std::string& row, const DemonstratedScenes& shown) {
  const auto all = std::make_shared<const std::map<std::string, std::vector<float>>>(committed_embeddings());
  const EmbeddingOf embedding = [all](const std::string& name) -> const std::vector<float>& {
    const auto found = all->find(name);
    if (found == all->end()) throw InputError(fmt::format("\"{}\": expected a name with a committed embedding", name));
    return found->second;
  };
  const Score score = [embedding](const Instance& one, const TakenLooks& taken) {
    return alike_in_name(one, taken, embedding);
  };
  return by_demonstrations(row, score, Counting::of_its_command, shown);
}

std::unique_ptr<Method> constant_action() { return std::make_unique<ConstantAction>(); }

// How a reference row acts: as a method that learns from demonstrations, or by a rule.
struct Acting {
  const char* row;
  std::unique_ptr<Method> (*method)();
  Actor (*rule)(const std::string& row, const DemonstratedScenes& shown);
};
constexpr Acting all_acting[] = {
    {"constant_action", constant_action, nullptr},
    {random_object, nullptr, any_object},
    {"oracle", nullptr, oracle},
    {"most_demonstrated", nullptr, most_demonstrated},
    {"least_demonstrated", nullptr, least_demonstrated},
    {"most_alike_names", nullptr, most_alike_names},
    {"most_shared", nullptr, most_shared},
    {"never_demonstrated", nullptr, never_demonstrated},
    {"stops_at_once", nullptr, stops_at_once},
    {"two_then_stops", nullptr, two_then_stops},
    {"stops_at_random", nullptr, stops_at_random},
};

const Acting& acting(const std::string& row) {
  for (const Acting& one : all_acting)
    if (row == one.row) return one;
  std::vector<std::string> known;
  for (const Acting& one : all_acting) known.emplace_back(one.row);
  throw InputError(fmt::format("reference row \"{}\": expected {}", row, fmt::join(known, ", ")));
}

}  // namespace

std::unique_ptr<Method> reference_method(const std::string& id) {
  const Acting& row = acting(id);
  return row.method ? row.method() : nullptr;
}

Actor reference_actor(const std::string& id, const DemonstratedScenes& shown) {
  const Acting& row = acting(id);
  return row.rule ? row.rule(id, shown) : Actor();
}

}  // namespace lgabench
