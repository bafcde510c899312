// An engine in front of another: tests override what they watch.
#pragma once
#include <memory>
#include <utility>
#include <vector>

#include <lgabench/core/physics_world.hpp>

namespace lgabench {

class ForwardingWorld : public PhysicsWorld {
 public:
  explicit ForwardingWorld(std::unique_ptr<PhysicsWorld> world) : world_(std::move(world)) {}
  void load(const std::vector<BodyModel>& models, int bodies) override { world_->load(models, bodies); }
  void reset(const std::vector<BodyPlacement>& placements) override { world_->reset(placements); }
  double time_step_s() const override { return world_->time_step_s(); }
  void step() override { world_->step(); }
  Pose pose(int body) const override { return world_->pose(body); }
  std::optional<BodyPhysics> physics(int body) const override { return world_->physics(body); }
  std::vector<Contact> contacts() const override { return world_->contacts(); }
  int cast_down(Vec2 point, double& height_m) const override { return world_->cast_down(point, height_m); }
  void grip(int body, const Pose& gripper) override { world_->grip(body, gripper); }
  void move_gripper(const Pose& gripper) override { world_->move_gripper(gripper); }
  void release() override { world_->release(); }
  void place_spatula(Vec3 size_m, const Pose& pose) override { world_->place_spatula(size_m, pose); }
  void move_spatula(const Pose& pose) override { world_->move_spatula(pose); }
  void remove_spatula() override { world_->remove_spatula(); }

 private:
  std::unique_ptr<PhysicsWorld> world_;
};

}  // namespace lgabench
