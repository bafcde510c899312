// How surfaces look in the light that all environments share: directions, brightness, texture coordinates.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <common/textures.hpp>
#include <lgabench/core/observation.hpp>
#include <lgabench/core/view.hpp>

namespace lgabench::common {

inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

/// Light from far away, the same everywhere.
struct Light {
  Vec3 towards = usual_light;
  double climb = 1 / towards.z;  // of the way to the light, for each metre of height
};
constexpr int ambient = shadow_brightness;  // in 1/256; a level surface in the light has 256, wherever that comes from

/// Texture coordinates: the plane that faces the surface most, in the body's frame, so that a picture turns with its
/// object; on top, u is local y (right at yaw 0) and v local x (down), on a side u is y or x and v is -z.
enum class Plane : std::uint16_t { top, side_yz, side_xz };

inline Plane plane_of(Vec3 normal) {
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  if (z >= x && z >= y) return Plane::top;
  return x >= y ? Plane::side_yz : Plane::side_xz;
}

/// What decides a triangle's colours: its brightness in the light, in 1/256 (256: the colour as it is, so that a
/// picture takes integers only), and its texture coordinates. Pixels in a row that look alike are painted at once.
struct Look {
  std::uint16_t brightness;
  Plane plane;
  bool operator==(const Look& other) const { return brightness == other.brightness && plane == other.plane; }
};

/// Light on a triangle with that normal, where it comes from there, both in the body's frame; `climb`: the light's.
inline Look look_of(Vec3 normal, Vec3 towards_light, double climb) {
  const double cosine = dot(normal, towards_light);
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): never negative
  const int light_here = cosine > 0 ? static_cast<int>((256 - ambient) * cosine * climb + 0.5) : 0;
  return {static_cast<std::uint16_t>(ambient + light_here), plane_of(normal)};
}

inline void paint_pixel(std::uint8_t* rgb, const Rgb& colour, int brightness) {
  for (std::size_t i = 0; i < 3; ++i)
    rgb[i] = static_cast<std::uint8_t>(std::min((colour[i] * brightness + 128) >> 8, 255));
}

}  // namespace lgabench::common
