// Points, rotations and poses. Lengths in metres, angles in radians, counter-clockwise seen from above.
#pragma once
#include <cmath>

namespace lgabench {

constexpr double pi = 3.14159265358979323846;

/// A point on a plane, or a way along it.
struct Vec2 {
  double x = 0, y = 0;
};
/// z is the height above the plane.
struct Vec3 {
  double x = 0, y = 0, z = 0;
};
/// Unit quaternion in the order x, y, z, w.
struct Quat {
  double x = 0, y = 0, z = 0, w = 1;
};
/// Where a body is and how it is turned: position in metres.
struct Pose {
  Vec3 position_m;
  Quat rotation;
};

inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
inline double norm(Vec2 a) { return std::sqrt(a.x * a.x + a.y * a.y); }
inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }

/// v turned by the angle about z.
inline Vec2 rotated(Vec2 v, double yaw_rad) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}
/// Rotation about z. w >= 0 for |yaw_rad| <= pi.
inline Quat from_yaw(double yaw_rad) { return {0, 0, std::sin(yaw_rad / 2), std::cos(yaw_rad / 2)}; }
/// Rotation about z that `q` holds, in (-pi, pi].
inline double yaw_of(const Quat& q) { return std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z)); }
/// Hamilton product: first b, then a.
inline Quat operator*(const Quat& a, const Quat& b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
/// v turned by the unit quaternion q.
inline Vec3 rotated(Vec3 v, const Quat& q) {
  const Vec3 u{q.x, q.y, q.z};
  const auto cross = [](Vec3 a, Vec3 b) {
    return Vec3{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  };
  const Vec3 t = 2.0 * cross(u, v);
  return v + q.w * t + cross(u, t);
}

}  // namespace lgabench
