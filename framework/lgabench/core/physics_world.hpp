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
  /// With the plane, the spatula and bodies of friction 1, times what it usually is; with another body as the engine
  /// combines two.
  double friction = 1;
};

/// What an engine simulates a body with.
struct BodyPhysics {
  Vec3 low_m, high_m;   // of the box about it now, along the world's axes
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

/// Bodies under gravity 9.81 m/s^2 on a plane, z = 0, without an end: a table's top, a floor. One thread.
/// Deterministic: the same calls give the same bits on one machine class. Owned by the host.
/// Every call @throws EngineError if the engine reports a warning, an instability or a value that is not finite, or
/// if it is called out of order (a body that is not placed, a move without a grip).
class PhysicsWorld {
 public:
  virtual ~PhysicsWorld() = default;

  /// Compiles what may be placed: at most `bodies` at once, of any of the models. Called once, before reset.
  /// @pre reset's outcome depends on this pool only through the models it places.
  virtual void load(const std::vector<BodyModel>& models, int bodies) = 0;

  /// Places the bodies at rest, drops all else (grip, spatula, velocities, solver state). Pure: same placements, same
  /// future.
  virtual void reset(const std::vector<BodyPlacement>& placements) = 0;

  /// Seconds of one step; does not change.
  virtual double time_step_s() const = 0;
  /// Advances the world by one step.
  virtual void step() = 0;

  /// Of the body's frame, in metres. `body`: index into reset()'s placements.
  virtual Pose pose(int body) const = 0;
  /// Read from what it simulates, not from what load() was given: shows that the one follows from the other.
  /// nullopt: it cannot tell.
  virtual std::optional<BodyPhysics> physics(int /*body*/) const { return std::nullopt; }
  /// Pairs in which both bodies are at rest may be left out.
  virtual std::vector<Contact> contacts() const = 0;

  /// First body hit by the vertical ray from above at `point`: no_body if only the plane. `height_m` gets z of the hit.
  /// The spatula is not seen.
  virtual int cast_down(Vec2 point, double& height_m) const = 0;

  /// Suction: holds `body` rigidly to a gripper that stands at `gripper`, until release(). @pre not a fixed body.
  virtual void grip(int body, const Pose& gripper) = 0;
  /// Where the gripper shall be after the next step.
  virtual void move_gripper(const Pose& gripper) = 0;
  /// Lets go; without a grip, nothing happens.
  virtual void release() = 0;

  /// A kinematic box (size along its own x, y, z) that pushes bodies; appears at `pose`.
  virtual void place_spatula(Vec3 size_m, const Pose& pose) = 0;
  /// Where the spatula shall be after the next step.
  virtual void move_spatula(const Pose& pose) = 0;
  /// It touches nothing any more.
  virtual void remove_spatula() = 0;
};

}  // namespace lgabench
