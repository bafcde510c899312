// The compiled model of MujocoWorld: a few bodies that take the shape of any model.
#pragma once
#include <mujoco/mujoco.h>
#include <memory>
#include <vector>

#include <lgabench/core/physics_world.hpp>

namespace lgabench {

constexpr double mujoco_time_step_s = 0.005;
/// No tree of boxes around a body's geoms, which would be that of the shape it was compiled with; an instability is an
/// error, not a new start.
constexpr int mujoco_disabled = mjDSBL_MIDPHASE | mjDSBL_AUTORESET;

/// A body: its addresses in the compiled model.
struct MujocoBody {
  int body = 0, first_geom = 0, geoms = 0;
  int mocap = -1;                      // fixed bodies
  int qpos = -1, dof = -1, tree = -1;  // free bodies
};

/// A table, a gripper (mocap), a spatula, `bodies` free and as many fixed bodies. Compiling takes milliseconds, and a
/// body costs every step, asleep or not: so that a scene's bodies are given their shapes in place, from numbers that
/// MuJoCo compiled for each model once. Bodies without a shape lie beside the table, without contacts and asleep.
class MujocoPool {
 public:
  /// @throws EngineError if a model does not compile.
  MujocoPool(const std::vector<BodyModel>& models, int bodies);

  mjModel* model() const { return model_.get(); }
  int gripper_mocap() const { return gripper_mocap_; }
  const MujocoBody& spatula() const { return spatula_; }

  /// Takes all back, then gives out a body for each of `models` (indices into those compiled). Which is whose depends
  /// on the models' indices first, then on their order: sums over contacts go along the bodies.
  /// @throws EngineError for a model that is not there, or too many; none is given out then.
  void give_out(const std::vector<int>& models);
  /// The bodies that give_out() gave, in the order that was asked for.
  const std::vector<MujocoBody>& given_out() const { return given_out_; }

  /// Holds the given out fixed bodies, whose poses `data` knows, where they are: to MuJoCo a mocap body moves at any
  /// time, and what touches one costs every step, asleep or not. Until the next give_out().
  void pin_fixed(mjData* data);

  /// Whether a body takes part in contacts.
  void set_collidable(const MujocoBody& body, bool collidable);

 private:
  using Model = std::unique_ptr<mjModel, void (*)(mjModel*)>;

  void set_mocap(const MujocoBody& body, bool mocap);
  void put_on(const MujocoBody& shape, MujocoBody& body) const;

  Model patterns_;                  // each of the models once, never simulated
  std::vector<MujocoBody> shapes_;  // in it, by model
  Model model_;
  MujocoBody spatula_;
  std::vector<MujocoBody> free_, fixed_, given_out_;
  int gripper_mocap_ = -1;
};

}  // namespace lgabench
