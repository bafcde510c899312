// MuJoCo without this project around it: what an episode costs at least.
#pragma once
#include <mujoco/mujoco.h>

#include <memory>
#include <vector>

#include <lgabench/core/physics_world.hpp>

namespace lgabench {

/// The gripper after one step of an episode.
struct GripperFrame {
  int held = no_body;
  Pose gripper, body_when_gripped, gripper_when_gripped;
};

/// A table and the bodies of one scene, in the options that the engine plugin uses.
class BareMujoco {
 public:
  BareMujoco(const std::vector<BodyModel>& models, const std::vector<BodyPlacement>& placements);
  /// mj_resetData and mj_forward: all bodies at their placements.
  void reset();
  /// One mj_step for each frame.
  void play(const std::vector<GripperFrame>& frames);
  mjModel* model() { return model_.get(); }
  mjData* data() { return data_.get(); }

 private:
  std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
  std::unique_ptr<mjData, void (*)(mjData*)> data_;
  std::vector<int> welds_;  // by placement; -1: fixed
};

/// The first test scene of `heart`.
BareMujoco& first_scene();

}  // namespace lgabench
