// The review's cheating plugin: makes the test scenes itself, recognises the one that it sees by its objects and their
// ids, and knows where the target lies. It needs the scenario with its truth, which it takes where it can.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <lgabench/core/files.hpp>
#include <lgabench/core/scenario.hpp>

#include "../fixture.hpp"
#include "tabletop/sampler.hpp"

namespace {

using namespace lgabench;

constexpr int scenes = 100;

class Cheat : public Policy {
 public:
  explicit Cheat(const Scenario& scenario) {
    const SceneRequest request{"cells", "test", scenario.tests.front().id, 0};
    for (int i = 0; i < scenes; ++i) known_.push_back(tabletop::sample_scene(scenario, request, i));
  }

  Action act(const Observation& observation, const Instruction&) override {
    const auto sees = [&observation](const SceneObject& object) {
      return std::any_of(observation.instances.begin(), observation.instances.end(), [&](const Instance& instance) {
        return instance.id == object.instance_id && instance.object_type == object.object_type &&
               instance.texture == object.texture;
      });
    };
    const auto shows = [&](const Scene& scene) {
      return scene.objects.size() == observation.instances.size() &&
             std::all_of(scene.objects.begin(), scene.objects.end(), sees);
    };
    const auto scene = std::find_if(known_.begin(), known_.end(), shows);
    if (scene == known_.end()) throw MethodError("a scene that is not known");
    const Vec2 from = scene->find(role::target)->position_m, to = scene->find(role::goal)->position_m;
    return fixture::from_to(from.x, from.y, to.x, to.y);
  }

 private:
  std::vector<Scene> known_;
};

class CheatMethod : public fixture::FixtureMethod<fixture::StayPolicy> {
 public:
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>&, Services& services) override {
    std::ifstream job("/proc/self/fd/0");  // a worker's standard input, if this were one
    const std::string text((std::istreambuf_iterator<char>(job)), {});
    const Json task = json_or_null(text);
    services.log.epoch(1, 1, 0.0);
    return std::make_unique<Cheat>(task.is_object() ? read_scenario(task.at("cell").at("scenario"), "job")
                                                    : load_scenario("heart"));
  }
};

}  // namespace

LGABENCH_METHOD("fixture_cheat", "0.1", "acts on scenes that it makes itself", CheatMethod, "{}")
