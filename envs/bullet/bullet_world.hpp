// Rigid bodies on Bullet, in double precision: shapes are made once, everything else anew for each scene.
#pragma once
#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>
#include <btBulletDynamicsCommon.h>
#include <memory>
#include <optional>
#include <vector>

#include <lgabench/core/physics_world.hpp>

#include "bullet/bullet_models.hpp"

namespace lgabench {

/// A Bullet world that was reset remembers its past, in the order of its pairs at least: reset() makes another one.
/// Suction drives what it holds: before each step the body gets the velocity that takes it to where the gripper shall
/// be, and contacts have the last word. The spatula is a kinematic body.
class BulletWorld final : public PhysicsWorld {
 public:
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
  struct Body {
    const BulletModel* model;
    Pose placed;        // by reset()
    btTransform start;  // the same, of the mass frame
    std::unique_ptr<btRigidBody> rigid;
  };
  /// Destroyed from the last to the first: the world lets go of the bodies before they go.
  struct Simulation {
    std::vector<Body> bodies;
    std::unique_ptr<btStaticPlaneShape> table_shape;
    std::unique_ptr<btBoxShape> spatula_shape;
    std::unique_ptr<btRigidBody> table, spatula;
    std::unique_ptr<btDefaultCollisionConfiguration> configuration;
    std::unique_ptr<btCollisionDispatcher> dispatcher;
    std::unique_ptr<btSimpleBroadphase> broadphase;
    std::unique_ptr<btSequentialImpulseConstraintSolver> solver;
    std::unique_ptr<btDiscreteDynamicsWorld> world;
  };
  struct Grip {
    int body;
    btTransform to_body;  // from the gripper to the held body's mass frame
    btTransform target;   // of the gripper, after the next step
  };

  const Body& body(int index) const;
  Simulation make_simulation(std::size_t bodies) const;
  void pull_held();

  std::vector<BulletModel> models_;
  std::size_t most_bodies_ = 0;
  std::unique_ptr<Simulation> now_;
  std::optional<Grip> grip_;
};

}  // namespace lgabench
