// Meshes in the light: where they stand, and whether they keep the light from a point (rays, Embree).
#pragma once
#include <fmt/format.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include <common/light.hpp>
#include <common/objects.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/observation.hpp>

struct RTCDeviceTy;
struct RTCSceneTy;

namespace lgabench::common {

/// A mesh, ready to be drawn. Owned by its Solids.
struct Solid {
  const Mesh* mesh;
  std::vector<Vec3> normals;  // of the triangles, unit, in the body's frame
  RTCSceneTy* rays;           // the mesh, for shadow rays in the body's frame
};

/// Every mesh that was asked for, made ready once. One thread at a time.
class Solids {
 public:
  /// @throws EngineError if Embree can't be started.
  Solids();
  ~Solids();
  Solids(const Solids&) = delete;
  Solids& operator=(const Solids&) = delete;

  /// @pre one name has one mesh, which outlives this.
  const Solid& of(const std::string& name, const Mesh& mesh);

 private:
  RTCDeviceTy* device_;
  std::map<std::string, Solid> solids_;
};

/// A solid at a pose, in a light.
struct PlacedSolid {
  PlacedSolid(const Solid& of, const Pose& pose, const Light& in);

  const Solid* solid;
  Vec3 position;
  std::array<Vec3, 3> axes;    // of the body, in the world
  std::vector<Vec3> vertices;  // in the world
  Vec3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  Light light;
  Vec3 towards_light;  // in the body's frame

  Vec3 to_body(Vec3 direction) const {
    return {dot(axes[0], direction), dot(axes[1], direction), dot(axes[2], direction)};
  }
  /// Stands between a point of a surface and the light.
  bool shades(Vec3 point) const;
  /// May do so for a point of the other: its box, drawn out to the end of its shadow, meets the other's.
  bool may_shade(const PlacedSolid& other) const;
};

/// Gives each its bit of Observation::shadows. @throws InputError for more than these have room for.
template <typename Placed>
void give_shadow_bits(std::vector<Placed>& placed) {
  if (placed.size() > most_shadows)
    throw InputError(
        fmt::format("scene: expected at most {} objects for shadows, got {}", most_shadows, placed.size()));
  for (std::size_t i = 0; i < placed.size(); ++i) placed[i].shadow_bit = static_cast<std::uint16_t>(1U << i);
}

}  // namespace lgabench::common
