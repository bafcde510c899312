// What an engine plugin provides: rigid bodies on a level plane. Tasks, success, pictures and the oracle are the
// environment's.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/geometry.hpp>

namespace lgabench {

/// A convex polytope given by its corners, in the body's frame (origin at the object type's centre, on its underside).
struct ConvexPiece {
  std::vector<Vec3> corners_m;
};

/// A rigid body that may be placed: pieces may touch or overlap; mass is spread evenly over their volume.
struct BodyModel {
  std::string name;
  std::vector<ConvexPiece> pieces;
  double mass_kg = 0.1;
  bool fixed = false;  // stays where reset() puts it, whatever touches it; cannot be gripped
  /// Friction with the plane, the spatula and bodies of friction 1, as a multiple of the usual one. With any other body
  /// it is what the engine combines from the two.
  double friction = 1;
};

/// What an engine simulates a body with.
struct BodyPhysics {
  Vec3 low_m, high_m;   // corners of the box about it now, along the world's axes
  double mass_kg = 0;   // 0 of a fixed one, and where bodies have no mass
  double friction = 0;  // with the plane; 0 where there is none
};

/// Where a body is put.
struct BodyPlacement {
  int model = 0;  // index into the models given to load()
  Pose pose;      // of the body's frame
};

/// Two bodies that touched during the last step. Bodies are named by their index into reset()'s placements.
struct Contact {
  int a = 0, b = 0;
};
constexpr int table_body = -1, spatula_body = -2, no_body = -3;

/// Bodies under gravity, 9.81 m/s^2, on the endless plane z = 0: a table's top or a floor. The host owns the world and
/// calls it from one thread. Deterministic: the same calls give the same bits on one machine class.
/// Every call @throws EngineError if the engine reports a warning, an instability or a value that is not finite, or
/// if it is called out of order (a body that is not placed, a move without a grip).
class PhysicsWorld {
 public:
  virtual ~PhysicsWorld() = default;

  /// Prepares the models, of which reset() places at most `bodies` at once. Called once, before reset(). The outcome of
  /// reset() must depend on this pool only through the models that it places.
  virtual void load(const std::vector<BodyModel>& models, int bodies) = 0;

  /// Places the bodies at rest and drops all other state (grip, spatula, velocities, solver). Pure: the same placements
  /// give the same future.
  virtual void reset(const std::vector<BodyPlacement>& placements) = 0;

  /// Seconds of one step; does not change.
  virtual double time_step_s() const = 0;
  /// Advances the world by one step.
  virtual void step() = 0;

  /// Pose of the body's frame, in metres. `body` is an index into reset()'s placements.
  virtual Pose pose(int body) const = 0;
  /// What the engine simulates the body with, read from the simulation and not from what load() was given: checks
  /// compare the two. nullopt where the engine cannot tell.
  virtual std::optional<BodyPhysics> physics(int /*body*/) const { return std::nullopt; }
  /// All contacts. An engine may leave out pairs in which both bodies are at rest.
  virtual std::vector<Contact> contacts() const = 0;

  /// The first body that a vertical ray from above hits at `point`, or no_body if it hits the plane. `height_m` gets z
  /// of the hit. The ray passes through the spatula.
  virtual int cast_down(Vec2 point, double& height_m) const = 0;

  /// Suction: holds `body` rigidly to a gripper that stands at `gripper`, until release(). @pre not a fixed body.
  virtual void grip(int body, const Pose& gripper) = 0;
  /// Sets where the gripper shall be after the next step.
  virtual void move_gripper(const Pose& gripper) = 0;
  /// Lets go; without a grip, nothing happens.
  virtual void release() = 0;

  /// Puts the spatula at `pose`: a kinematic box that pushes bodies. `size_m` is along its own x, y, z.
  virtual void place_spatula(Vec3 size_m, const Pose& pose) = 0;
  /// Sets where the spatula shall be after the next step.
  virtual void move_spatula(const Pose& pose) = 0;
  /// Removes the spatula, which then touches nothing.
  virtual void remove_spatula() = 0;
};

}  // namespace lgabench
