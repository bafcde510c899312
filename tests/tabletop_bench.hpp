// The tabletop over the engine under test.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/environment.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/tabletop.hpp>
#include <tabletop/two_poses.hpp>

#include "engine_under_test.hpp"
#include "forwarding_world.hpp"

namespace lgabench::tabletop {

/// The engine, with an eye kept on the bodies that the environment does not show.
class WatchedWorld : public ForwardingWorld {
 public:
  using ForwardingWorld::ForwardingWorld;
  void reset(const std::vector<BodyPlacement>& placements) override {
    ForwardingWorld::reset(placements);
    steps = 0;
  }
  void step() override {
    ForwardingWorld::step();
    ++steps;
  }
  Pose pose(int body) const override {
    Pose pose = ForwardingWorld::pose(body);
    if (creeps) pose.position_m.x += 2e-3 * time_step_s() * steps;
    return pose;
  }

  bool creeps = false;  // all bodies, at 2 mm/s
  int steps = 0;        // since reset
};

struct Bench {
  WatchedWorld* world;
  std::unique_ptr<Environment> environment;
};

inline Bench make_bench(const std::string& space = "tabletop", int bodies = most_bodies) {
  auto world = std::make_unique<WatchedWorld>(make_engine());
  WatchedWorld* const watched = world.get();
  return {watched, make_environment(std::move(world), load_feature_space(space), bodies)};
}

/// One for all tests, as loading the object types takes its time.
inline Bench& bench(const std::string& space = "tabletop", int bodies = most_bodies) {
  static std::map<std::pair<std::string, int>, Bench> shared;
  const auto found = shared.find({space, bodies});
  if (found != shared.end()) return found->second;
  return shared.emplace(std::pair(space, bodies), make_bench(space, bodies)).first->second;
}
inline Environment& environment() { return *bench().environment; }

inline SceneObject object(const std::string& type, const std::string& texture, const Role& role, Vec2 position,
                          std::uint8_t id) {
  SceneObject o;
  o.object_type = type;
  o.texture = texture;
  o.role = role;
  o.position_m = position;
  o.instance_id = id;
  return o;
}

inline TwoPoses from_to(Vec2 from, Vec2 to) { return {{from, {}}, {to, {}}}; }

struct Episode {
  Observation first;
  TwoPoses action;
  StepResult result;
};
inline Episode play(Environment& env, const Scene& scene) {
  Episode episode;
  episode.first = env.reset(scene);
  episode.action = env.expert_action();
  episode.result = env.step(episode.action);
  return episode;
}

}  // namespace lgabench::tabletop
