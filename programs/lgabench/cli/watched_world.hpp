// An engine that lets somebody look on while an action is carried out.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <lgabench/core/physics_world.hpp>

namespace lgabench::cli {

/// What acts on the bodies at a moment: where suction holds, or the box that pushes.
struct Tool {
  Pose pose;
  std::optional<Vec3> box_m;  // a spatula's size; none for suction
};

/// Passes every call on, and tells `look` every `period_s` of simulated time, before the step. One thread.
class WatchedWorld final : public PhysicsWorld {
 public:
  using Look = std::function<void(const std::optional<Tool>& tool)>;
  WatchedWorld(std::unique_ptr<PhysicsWorld> world, double period_s, Look look)
      : world_(std::move(world)), look_(std::move(look)), period_s_(period_s) {}

  void load(const std::vector<BodyModel>& models, int bodies) override { world_->load(models, bodies); }
  void reset(const std::vector<BodyPlacement>& placements) override {
    world_->reset(placements);
    tool_.reset();
    elapsed_s_ = period_s_;
  }
  double time_step_s() const override { return world_->time_step_s(); }
  void step() override {
    if (elapsed_s_ >= period_s_) {
      look_(tool_);
      elapsed_s_ = 0;
    }
    elapsed_s_ += time_step_s();
    world_->step();
  }
  Pose pose(int body) const override { return world_->pose(body); }
  std::optional<BodyPhysics> physics(int body) const override { return world_->physics(body); }
  std::vector<Contact> contacts() const override { return world_->contacts(); }
  int cast_down(Vec2 point, double& height_m) const override { return world_->cast_down(point, height_m); }
  void grip(int body, const Pose& gripper) override {
    world_->grip(body, gripper);
    tool_ = Tool{gripper, std::nullopt};
  }
  void move_gripper(const Pose& gripper) override {
    world_->move_gripper(gripper);
    tool_ = Tool{gripper, std::nullopt};
  }
  void release() override {
    world_->release();
    tool_.reset();
  }
  void place_spatula(Vec3 size_m, const Pose& pose) override {
    world_->place_spatula(size_m, pose);
    tool_ = Tool{pose, size_m};
  }
  void move_spatula(const Pose& pose) override {
    world_->move_spatula(pose);
    tool_->pose = pose;
  }
  void remove_spatula() override {
    world_->remove_spatula();
    tool_.reset();
  }

 private:
  std::unique_ptr<PhysicsWorld> world_;
  Look look_;
  double period_s_, elapsed_s_ = 0;
  std::optional<Tool> tool_;
};

}  // namespace lgabench::cli
