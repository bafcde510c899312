// Bodies as Bullet wants them: a collision shape whose origin is the centre of mass, and principal moments of inertia.
#pragma once
#include <btBulletDynamicsCommon.h>
#include <memory>
#include <vector>

#include <lgabench/core/physics_world.hpp>

namespace lgabench {

inline btVector3 to_bullet(const Vec3& v) { return {v.x, v.y, v.z}; }
inline btTransform to_bullet(const Pose& pose) {
  const Quat& q = pose.rotation;
  return btTransform(btQuaternion(q.x, q.y, q.z, q.w), to_bullet(pose.position_m));
}
inline Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Pose from_bullet(const btTransform& t) {
  const btQuaternion q = t.getRotation();
  const btVector3& p = t.getOrigin();
  return {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

/// What may be placed. Constant once made: every body of the model, in every scene, shares it.
struct BulletModel {
  std::vector<std::unique_ptr<btConvexHullShape>> pieces;  // in the mass frame
  std::unique_ptr<btCompoundShape> compound;               // of several pieces
  btTransform mass_frame;                                  // centre of mass and principal axes, in the body's frame
  btVector3 inertia;                                       // about these axes, kg m^2
  double mass_kg = 0;
  double friction = 1;  // BodyModel's
  bool fixed = false;

  btCollisionShape* shape() const;
};

/// @throws EngineError for a piece without volume.
BulletModel make_bullet_model(const BodyModel& body);

/// Height at which the vertical line through `point` leaves the piece at `transform`; -infinity where it passes by.
double top_at(const btConvexHullShape& piece, const btTransform& transform, Vec2 point);

}  // namespace lgabench
