// Rigid bodies on MuJoCo.
#pragma once
#include <mujoco/mujoco.h>
#include <memory>
#include <optional>
#include <vector>

#include <lgabench/core/physics_world.hpp>

#include "mujoco/mujoco_pool.hpp"

namespace lgabench {

/// reset() always starts from the same pristine state of the pool, so no scene sees an earlier one. Suction is a weld
/// to a mocap body. The spatula is a very heavy free body, set on its way before each step: contacts take a mocap body
/// to stand still, and let what it pushes sink into it.
class MujocoWorld final : public PhysicsWorld {
 public:
  MujocoWorld();

  void load(const std::vector<BodyModel>& models, int bodies) override;
  void reset(const std::vector<BodyPlacement>& placements) override;
  double time_step_s() const override;
  void step() override;
  Pose pose(int body) const override;
  std::optional<BodyPhysics> physics(int body) const override;
  std::vector<Contact> contacts() const override;
  int cast_down(Vec2 point, double& height_m) const override;
  void grip(int body, const Pose& gripper) override;
  void move_gripper(const Pose& gripper) override;
  void release() override;
  void place_spatula(Vec3 size_m, const Pose& pose) override;
  void move_spatula(const Pose& pose) override;
  void remove_spatula() override;

 private:
  void expect_loaded(const char* call) const;
  const MujocoBody& placed(int body) const;
  void set_mocap(int mocap, const Pose& pose);
  void park_spatula();
  void drive_spatula();
  /// Bodies are placed at rest: they sleep until something touches them, and cost nothing before.
  void lay_to_sleep();
  void refresh() const;
  void check() const;

  std::optional<MujocoPool> pool_;
  mjModel* model_ = nullptr;                                    // the pool's
  std::unique_ptr<mjData, void (*)(mjData*)> data_, pristine_;  // pristine: everything parked and asleep
  std::vector<int> owner_;            // by geom: placement, table_body, spatula_body or no_body
  std::optional<Pose> spatula_pose_;  // where it shall be after the next step; none: parked
  int held_ = no_body;
  mutable bool stale_ = false;  // positions of geoms are one step behind the state
};

}  // namespace lgabench
