#include <common/solids.hpp>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <new>

#include <lgabench/core/error.hpp>

namespace lgabench::common {
namespace {

constexpr double clearance_m = 2e-4;  // what a shadow ray leaves behind, so that a surface does not shade itself

[[noreturn]] void fail(const std::string& what, RTCError error) {
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();  // a limit of this process, as with any other memory
  throw EngineError(fmt::format("Embree: {}, error {}", what, static_cast<int>(error)));
}

}  // namespace

// One fixed instruction set, so that no machine takes another path through Embree; every x86-64 since 2008 has it.
Solids::Solids() : device_(rtcNewDevice("threads=1,isa=sse4.2")) {
  if (!device_) fail("not started", rtcGetDeviceError(nullptr));
}

Solids::~Solids() {
  for (const auto& [name, solid] : solids_) rtcReleaseScene(solid.rays);
  rtcReleaseDevice(device_);
}

const Solid& Solids::of(const std::string& name, const Mesh& mesh) {
  const auto known = solids_.find(name);
  if (known != solids_.end()) return known->second;
  Solid solid{&mesh, {}, rtcNewScene(device_)};
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 normal = cross(mesh.vertices_m[b] - mesh.vertices_m[a], mesh.vertices_m[c] - mesh.vertices_m[a]);
    solid.normals.push_back((1 / std::sqrt(dot(normal, normal))) * normal);
  }
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertices_m.size()));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
  if (!vertices || !indices) throw std::bad_alloc();
  for (const Vec3& v : mesh.vertices_m)
    for (const double number : {v.x, v.y, v.z}) *vertices++ = static_cast<float>(number);
  for (const auto& triangle : mesh.triangles) indices = std::copy(triangle.begin(), triangle.end(), indices);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(solid.rays, geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneFlags(solid.rays, RTC_SCENE_FLAG_ROBUST);  // no ray slips through between two triangles
  rtcCommitScene(solid.rays);
  if (const RTCError error = rtcGetDeviceError(device_)) fail(fmt::format("the mesh of \"{}\"", name), error);
  return solids_.emplace(name, std::move(solid)).first->second;
}

PlacedSolid::PlacedSolid(const Solid& of, const Pose& pose, const Light& in)
    : solid(&of),
      position(pose.position_m),
      axes{rotated({1, 0, 0}, pose.rotation), rotated({0, 1, 0}, pose.rotation), rotated({0, 0, 1}, pose.rotation)},
      light(in),
      towards_light(to_body(in.towards)) {
  vertices.reserve(of.mesh->vertices_m.size());
  for (const Vec3& local : of.mesh->vertices_m) {
    const Vec3 v = vertices.emplace_back(position + local.x * axes[0] + local.y * axes[1] + local.z * axes[2]);
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
}

bool PlacedSolid::shades(Vec3 point) const {
  const double below_top = high.z - point.z;
  if (below_top < clearance_m) return false;
  // The way to the light, as far as it is no higher than the solid, against the solid's box.
  const double way = below_top * light.climb;
  const auto passes = [](double from, double to, double low, double high) {
    return std::min(from, to) > high || std::max(from, to) < low;
  };
  if (passes(point.x, point.x + way * light.towards.x, low.x, high.x) ||
      passes(point.y, point.y + way * light.towards.y, low.y, high.y))
    return false;
  const Vec3 origin = to_body(point - position);
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x);
  ray.org_y = static_cast<float>(origin.y);
  ray.org_z = static_cast<float>(origin.z);
  ray.dir_x = static_cast<float>(towards_light.x);
  ray.dir_y = static_cast<float>(towards_light.y);
  ray.dir_z = static_cast<float>(towards_light.z);
  ray.tnear = static_cast<float>(clearance_m);
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = ~0u;
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(solid->rays, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(solid->rays, &context, &ray);
#endif
  return ray.tfar < 0;  // Embree's mark of a hit
}

bool PlacedSolid::may_shade(const PlacedSolid& other) const {
  constexpr double slack = 1e-6;  // more than rounding
  const double reach = (high.z - other.low.z) * light.climb;
  const Vec2 shadow{-reach * light.towards.x, -reach * light.towards.y};
  return reach >= 0 && other.low.x <= high.x + std::max(0., shadow.x) + slack &&
         other.high.x >= low.x + std::min(0., shadow.x) - slack &&
         other.low.y <= high.y + std::max(0., shadow.y) + slack &&
         other.high.y >= low.y + std::min(0., shadow.y) - slack;
}

}  // namespace lgabench::common
