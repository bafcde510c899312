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

#include "engine_under_test.hpp"

namespace lgabench::tabletop {

/// The engine, with an eye kept on the bodies that the environment does not show.
class WatchedWorld : public PhysicsWorld {
 public:
  explicit WatchedWorld(std::unique_ptr<PhysicsWorld> world) : world_(std::move(world)) {}
  void load(const std::vector<BodyModel>& models, int copies) override { world_->load(models, copies); }
  void reset(const std::vector<BodyPlacement>& placements) override {
    world_->reset(placements);
    steps = 0;
  }
  double time_step_s() const override { return world_->time_step_s(); }
  void step() override {
    world_->step();
    ++steps;
  }
  Pose pose(int body) const override {
    Pose pose = world_->pose(body);
    if (creeps) pose.position_m.x += 2e-3 * world_->time_step_s() * steps;
    return pose;
  }
  std::vector<Contact> contacts() const override { return world_->contacts(); }
  int cast_down(Vec2 point, double& height_m) const override { return world_->cast_down(point, height_m); }
  void grip(int body, const Pose& gripper) override { world_->grip(body, gripper); }
  void move_gripper(const Pose& gripper) override { world_->move_gripper(gripper); }
  void release() override { world_->release(); }
  void place_spatula(Vec3 size_m, const Pose& pose) override { world_->place_spatula(size_m, pose); }
  void move_spatula(const Pose& pose) override { world_->move_spatula(pose); }
  void remove_spatula() override { world_->remove_spatula(); }

  bool creeps = false;  // all bodies, at 2 mm/s
  int steps = 0;        // since reset

 private:
  std::unique_ptr<PhysicsWorld> world_;
};

struct Bench {
  WatchedWorld* world;
  std::unique_ptr<Environment> environment;
};

inline Bench make_bench(const std::string& space = "tabletop") {
  auto world = std::make_unique<WatchedWorld>(make_engine());
  WatchedWorld* const watched = world.get();
  return {watched, make_environment(std::move(world), load_feature_space(space))};
}

/// One for all tests, as loading the object types takes its time.
inline Bench& bench(const std::string& space = "tabletop") {
  static std::map<std::string, Bench> shared;
  const auto found = shared.find(space);
  return found != shared.end() ? found->second : shared.emplace(space, make_bench(space)).first->second;
}
inline Environment& environment() { return *bench().environment; }

inline SceneObject object(const std::string& type, const std::string& texture, Role role, Vec2 position,
                          std::uint8_t id) {
  SceneObject o;
  o.object_type = type;
  o.texture = texture;
  o.role = role;
  o.position_m = position;
  o.instance_id = id;
  return o;
}

inline Action from_to(Vec2 from, Vec2 to) { return {{from, {}}, {to, {}}}; }

struct Episode {
  Observation first;
  Action action;
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
