#include "bullet/bullet_models.hpp"

#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <fmt/format.h>
#include <algorithm>
#include <limits>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

/// Polyhedral features let Bullet clip face against face, to the digit: no margin is needed around the shape.
std::unique_ptr<btConvexHullShape> make_hull(const ConvexPiece& piece, const btTransform& body_to_shape) {
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Vec3& corner : piece.corners_m) hull->addPoint(body_to_shape * to_bullet(corner), false);
  hull->setMargin(0);
  hull->recalcLocalAabb();
  hull->initializePolyhedralFeatures();
  return hull;
}

/// Integrals of 1, x and x xT over a body's volume.
struct Moments {
  double volume = 0;
  btVector3 first{0, 0, 0};
  btMatrix3x3 second{0, 0, 0, 0, 0, 0, 0, 0, 0};
};

/// Adds the tetrahedron between the origin and a triangle, negative where the triangle faces the origin.
void add(Moments& m, const btVector3& a, const btVector3& b, const btVector3& c) {
  const double volume = a.dot(b.cross(c)) / 6;
  const btVector3 sum = a + b + c;
  m.volume += volume;
  m.first += volume / 4 * sum;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      m.second[i][j] += volume / 20 * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + sum[i] * sum[j]);
}

void add(Moments& m, const btConvexPolyhedron& hull) {
  for (int f = 0; f < hull.m_faces.size(); ++f) {
    const btFace& face = hull.m_faces[f];
    const auto corner = [&](int i) -> const btVector3& { return hull.m_vertices[face.m_indices[i]]; };
    const btVector3 outward(face.m_plane[0], face.m_plane[1], face.m_plane[2]);
    for (int i = 1; i + 1 < face.m_indices.size(); ++i) {
      const btVector3 &a = corner(0), &b = corner(i), &c = corner(i + 1);
      if ((b - a).cross(c - a).dot(outward) > 0)
        add(m, a, b, c);
      else
        add(m, a, c, b);
    }
  }
}

}  // namespace

btCollisionShape* BulletModel::shape() const {
  return compound ? static_cast<btCollisionShape*>(compound.get()) : pieces.front().get();
}

BulletModel make_bullet_model(const BodyModel& body) {
  constexpr double least_volume_m3 = 1e-12;
  Moments moments;
  for (const ConvexPiece& piece : body.pieces) {
    const double before = moments.volume;
    const auto hull = make_hull(piece, btTransform::getIdentity());
    if (const btConvexPolyhedron* faces = hull->getConvexPolyhedron()) add(moments, *faces);
    if (!(moments.volume - before > least_volume_m3))
      throw EngineError(fmt::format("Bullet: a piece of \"{}\" has no volume", body.name));
  }
  if (body.pieces.empty()) throw EngineError(fmt::format("Bullet: \"{}\" has no pieces", body.name));

  BulletModel model;
  model.fixed = body.fixed;
  model.friction = body.friction;
  model.mass_kg = body.fixed ? 0 : body.mass_kg;
  const btVector3 centre = moments.first / moments.volume;
  btMatrix3x3 inertia(0, 0, 0, 0, 0, 0, 0, 0, 0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      inertia[i][j] = -model.mass_kg * (moments.second[i][j] / moments.volume - centre[i] * centre[j]);
  const double trace = -(inertia[0][0] + inertia[1][1] + inertia[2][2]);
  for (int i = 0; i < 3; ++i) inertia[i][i] += trace;
  btMatrix3x3 axes = btMatrix3x3::getIdentity();
  constexpr double precision = 1e-12;
  constexpr int most_turns = 50;
  inertia.diagonalize(axes, precision, most_turns);
  model.inertia = {inertia[0][0], inertia[1][1], inertia[2][2]};
  model.mass_frame = btTransform(axes, centre);

  for (const ConvexPiece& piece : body.pieces) model.pieces.push_back(make_hull(piece, model.mass_frame.inverse()));
  if (model.pieces.size() > 1) {
    model.compound = std::make_unique<btCompoundShape>();
    model.compound->setMargin(0);
    for (const auto& piece : model.pieces) model.compound->addChildShape(btTransform::getIdentity(), piece.get());
  }
  return model;
}

double top_at(const btConvexHullShape& piece, const btTransform& transform, Vec2 point) {
  constexpr double infinity = std::numeric_limits<double>::infinity(), tolerance_m = 1e-6, vertical = 1e-9;
  const btConvexPolyhedron& hull = *piece.getConvexPolyhedron();
  double top = infinity, bottom = -infinity;
  for (int f = 0; f < hull.m_faces.size(); ++f) {
    const btFace& face = hull.m_faces[f];
    const btVector3 normal = transform.getBasis() * btVector3(face.m_plane[0], face.m_plane[1], face.m_plane[2]);
    const btVector3 corner = transform * hull.m_vertices[face.m_indices[0]];
    // Inside this face: normal.z * z <= room.
    const double room = normal.dot(corner) - normal.x() * point.x - normal.y() * point.y;
    if (normal.z() > vertical)
      top = std::min(top, room / normal.z());
    else if (normal.z() < -vertical)
      bottom = std::max(bottom, room / normal.z());
    else if (room < -tolerance_m)
      return -infinity;
  }
  return bottom <= top + tolerance_m ? top : -infinity;
}

}  // namespace lgabench
