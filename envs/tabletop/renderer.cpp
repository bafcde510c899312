// The camera looks straight down and the table is flat, so what it sees of the objects and the shadows that they throw
// on the table are triangles filled in the picture: exact at every pixel's centre, in double precision, hence the same
// on every processor. Only light on the objects themselves takes rays (Embree), and few points need one.
#include <tabletop/renderer.hpp>

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <new>

#include <lgabench/core/error.hpp>
#include <tabletop/objects.hpp>
#include <tabletop/raster.hpp>
#include <tabletop/textures.hpp>
#include <tabletop/zones.hpp>

namespace lgabench::tabletop {
namespace {

constexpr Rgb table_colour{196, 194, 190}, zone_colour{168, 184, 176};
// Towards the light, a unit vector: from above, the picture's upper left. Shadows fall to the lower right.
constexpr Vec3 light{-0.36, -0.48, 0.8};
constexpr double climb = 1 / light.z;  // of the way to the light, for each metre of height
constexpr int ambient = 141;           // brightness in shadow; a level surface in the light has 256
constexpr double clearance_m = 2e-4;   // what a shadow ray leaves behind, so that a surface does not shade itself

double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
// Where the shadow of a point falls on the table.
Vec2 shadow_of(Vec3 p) { return in_picture(p.x - p.z * climb * light.x, p.y - p.z * climb * light.y); }

// Texture coordinates: the plane that faces the surface most, in the body's frame, so that a picture turns with its
// object; on top, u is local y (right at yaw 0) and v local x (down), on a side u is y or x and v is -z.
enum class Plane : std::uint16_t { top, side_yz, side_xz };

Plane plane_of(Vec3 normal) {
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  if (z >= x && z >= y) return Plane::top;
  return x >= y ? Plane::side_yz : Plane::side_xz;
}

// What decides a triangle's colours: its brightness in the light, in 1/256 (256: the colour as it is, so that a picture
// takes integers only), and its texture coordinates. Pixels in a row that look alike are painted at once.
struct Look {
  std::uint16_t brightness;
  Plane plane;
  bool operator==(const Look& other) const { return brightness == other.brightness && plane == other.plane; }
};

// An object type, ready to be drawn.
struct Solid {
  const Mesh* mesh;
  std::vector<Vec3> normals;  // of the triangles, unit, in the body's frame
  RTCScene scene;             // the mesh, for shadow rays in the body's frame
};

// A solid in this picture.
struct Placed {
  const Solid* solid;
  const Texture* texture;
  std::uint8_t id;
  Vec3 position;
  std::array<Vec3, 3> axes;              // of the body, in the world
  std::vector<Vec3> vertices;            // in the world
  std::vector<Vec2> seen_at, shadow_at;  // where the camera sees each vertex, where its shadow falls
  Vec3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  Vec3 light;              // in the body's frame
  Area area, shadow_area;  // hold all that is seen of it, and its shadow on the table

  Vec3 to_body(Vec3 direction) const {
    return {dot(axes[0], direction), dot(axes[1], direction), dot(axes[2], direction)};
  }
};

void paint_pixel(std::uint8_t* rgb, const Rgb& colour, int brightness) {
  for (std::size_t i = 0; i < 3; ++i)
    rgb[i] = static_cast<std::uint8_t>(std::min((colour[i] * brightness + 128) >> 8, 255));
}

// The table without objects, at that brightness everywhere.
std::vector<std::uint8_t> empty_table(Ground ground, int brightness) {
  std::vector<std::uint8_t> rgb(3 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const double y = Workspace::y_min + (static_cast<double>(i % columns) + 0.5) * column_m;
    const bool zone = ground == Ground::goal_zones && GoalZones::contains({0, y});
    paint_pixel(&rgb[3 * i], zone ? zone_colour : table_colour, brightness);
  }
  return rgb;
}

struct Table {
  std::vector<std::uint8_t> in_light, in_shadow;
};
const Table& table(Ground ground) {
  const auto make = [](Ground g) { return Table{empty_table(g, 256), empty_table(g, ambient)}; };
  static const Table plain = make(Ground::plain), with_zones = make(Ground::goal_zones);
  return ground == Ground::plain ? plain : with_zones;
}

}  // namespace

std::vector<VisibleObject> visible_objects(const Scene& scene) {
  std::vector<VisibleObject> objects;
  for (const SceneObject& o : scene.objects)
    objects.push_back(
        {o.object_type, o.texture, {{o.position_m.x, o.position_m.y, 0}, from_yaw(o.yaw_rad)}, o.instance_id});
  return objects;
}

struct Renderer::Impl {
  RTCDevice device;
  std::map<std::string, Solid> solids;  // by object type, made at first use
  // Of the picture in work: how high the highest is at a pixel, and its look; valid in the areas of objects.
  std::vector<double> heights_m;
  std::vector<Look> looks;
  std::vector<std::uint8_t> shadow;  // pixels to which an object keeps the light from the table; all 0 between pictures

  Impl() : heights_m(pixels), looks(pixels), shadow(pixels) {
    // One fixed instruction set, so that no machine takes another path through Embree; every x86-64 since 2008 has it.
    device = rtcNewDevice("threads=1,isa=sse4.2");
    if (!device) fail("not started", rtcGetDeviceError(nullptr));
  }

  [[noreturn]] static void fail(const std::string& what, RTCError error) {
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();  // a limit of this process, as with any other memory
    throw EngineError(fmt::format("Embree: {}, error {}", what, static_cast<int>(error)));
  }

  ~Impl() {
    for (const auto& [type, solid] : solids) rtcReleaseScene(solid.scene);
    rtcReleaseDevice(device);
  }

  const Solid& solid_of(const std::string& type) {
    const auto known = solids.find(type);
    if (known != solids.end()) return known->second;
    const Mesh& mesh = object_model(type).mesh;
    Solid solid{&mesh, {}, rtcNewScene(device)};
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 normal = cross(mesh.vertices_m[b] - mesh.vertices_m[a], mesh.vertices_m[c] - mesh.vertices_m[a]);
      solid.normals.push_back((1 / std::sqrt(dot(normal, normal))) * normal);
    }
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.vertices_m.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
    if (!vertices || !indices) throw std::bad_alloc();
    for (const Vec3& v : mesh.vertices_m)
      for (const double number : {v.x, v.y, v.z}) *vertices++ = static_cast<float>(number);
    for (const auto& triangle : mesh.triangles) indices = std::copy(triangle.begin(), triangle.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(solid.scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(solid.scene, RTC_SCENE_FLAG_ROBUST);  // no ray slips through between two triangles
    rtcCommitScene(solid.scene);
    if (const RTCError error = rtcGetDeviceError(device)) fail(fmt::format("the mesh of \"{}\"", type), error);
    return solids.emplace(type, std::move(solid)).first->second;
  }

  Placed place(const VisibleObject& object) {
    const auto& [p, q] = object.pose;
    for (const double number : {p.x, p.y, p.z, q.x, q.y, q.z, q.w})
      if (!std::isfinite(number))
        throw InputError(fmt::format("instance {}: expected a finite pose, got {}", object.instance_id, number));
    Placed placed;
    placed.solid = &solid_of(object.object_type);
    placed.texture = &texture(object.texture);
    placed.id = object.instance_id;
    placed.position = p;
    placed.axes = {rotated({1, 0, 0}, q), rotated({0, 1, 0}, q), rotated({0, 0, 1}, q)};
    placed.light = placed.to_body(light);
    const std::vector<Vec3>& locals = placed.solid->mesh->vertices_m;
    placed.vertices.reserve(locals.size());
    placed.seen_at.reserve(locals.size());
    placed.shadow_at.reserve(locals.size());
    Vec2 shadow_low{1e9, 1e9}, shadow_high{-1e9, -1e9};
    for (const Vec3& local : locals) {
      const Vec3 v = p + local.x * placed.axes[0] + local.y * placed.axes[1] + local.z * placed.axes[2];
      placed.vertices.push_back(v);
      placed.seen_at.push_back(in_picture(v.x, v.y));
      const Vec2& shadow_at = placed.shadow_at.emplace_back(shadow_of(v));
      shadow_low = {std::min(shadow_low.x, shadow_at.x), std::min(shadow_low.y, shadow_at.y)};
      shadow_high = {std::max(shadow_high.x, shadow_at.x), std::max(shadow_high.y, shadow_at.y)};
      placed.low = {std::min(placed.low.x, v.x), std::min(placed.low.y, v.y), std::min(placed.low.z, v.z)};
      placed.high = {std::max(placed.high.x, v.x), std::max(placed.high.y, v.y), std::max(placed.high.z, v.z)};
    }
    placed.shadow_area = area_of(shadow_low, shadow_high);
    placed.area = area_of(in_picture(placed.low.x, placed.low.y), in_picture(placed.high.x, placed.high.y));
    return placed;
  }

  // The table is what is highest in the area.
  void clear(const Area& area) {
    for (int row = area.first_row; row <= area.last_row; ++row)
      for (int column = area.first_column; column <= area.last_column; ++column) heights_m[row * columns + column] = 0;
  }

  // Ids of the pixels where this object is the highest so far, and what of it is seen there.
  void draw(const Placed& object, Observation& seen) {
    for (std::uint32_t i = 0; i < object.solid->normals.size(); ++i) {
      const auto [ia, ib, ic] = object.solid->mesh->triangles[i];
      const Vec2 at_a = object.seen_at[ia], at_b = object.seen_at[ib], at_c = object.seen_at[ic];
      if (doubled_area(at_a, at_b, at_c) < least_area) continue;
      const Vec3 normal = object.solid->normals[i];
      const double cosine = dot(normal, object.light);
      const int light_here = cosine > 0 ? static_cast<int>((256 - ambient) * cosine * climb + 0.5) : 0;
      const Look look{static_cast<std::uint16_t>(ambient + light_here), plane_of(normal)};
      const double a = object.vertices[ia].z, b = object.vertices[ib].z, c = object.vertices[ic].z;
      const auto keep_highest = [&](int pixel, double height) {
        if (height <= heights_m[pixel]) return;
        heights_m[pixel] = height;
        looks[pixel] = look;
        seen.ids[pixel] = object.id;
      };
      if (a == b && a == c) {  // as tops of prisms are, which most pixels show
        fill(at_a, at_b, at_c, [&](int row, int begin, int end) {
          for (int column = begin; column < end; ++column) keep_highest(row * columns + column, a);
        });
        continue;
      }
      const double area = doubled_area(at_a, at_b, at_c);
      fill(at_a, at_b, at_c, [&](int row, int begin, int end) {
        for (int column = begin; column < end; ++column) {
          const Vec2 p{row + 0.0, column + 0.0};
          const double of_b = cross(at_a - at_c, p - at_c) / area, of_c = cross(at_b - at_a, p - at_a) / area;
          keep_highest(row * columns + column, a + of_b * (b - a) + of_c * (c - a));
        }
      });
    }
  }

  // Darkens the table where the object keeps the light from it.
  void shade_table(const Placed& object, const Table& table, Observation& seen) {
    std::uint8_t* const dark = shadow.data();
    for (const auto& [a, b, c] : object.solid->mesh->triangles)
      fill(object.shadow_at[a], object.shadow_at[b], object.shadow_at[c], [dark](int row, int begin, int end) {
        std::memset(dark + row * columns + begin, 1, static_cast<std::size_t>(end - begin));
      });
    const std::uint8_t *const ids = seen.ids.data(), *const shaded = table.in_shadow.data();
    std::uint8_t* const rgb = seen.rgb.data();
    const auto [first_row, last_row, first_column, last_column] = object.shadow_area;
    for (int row = first_row; row <= last_row; ++row)
      for (int pixel = row * columns + first_column; pixel <= row * columns + last_column; ++pixel) {
        if (dark[pixel] && !ids[pixel]) std::copy_n(shaded + 3 * pixel, 3, rgb + 3 * pixel);
        dark[pixel] = 0;
      }
  }

  // The object stands between the point (x, y, z) on a surface and the light.
  static bool shades(const Placed& object, double x, double y, double z) {
    const double below_top = object.high.z - z;
    if (below_top < clearance_m) return false;
    // The way to the light, as far as it is no higher than the object, against the object's box.
    const double way = below_top * climb;
    if (x + way * light.x > object.high.x || x < object.low.x || y + way * light.y > object.high.y || y < object.low.y)
      return false;
    const Vec3 origin = object.to_body(Vec3{x, y, z} - object.position);
    RTCRay ray{};
    ray.org_x = static_cast<float>(origin.x);
    ray.org_y = static_cast<float>(origin.y);
    ray.org_z = static_cast<float>(origin.z);
    ray.dir_x = static_cast<float>(object.light.x);
    ray.dir_y = static_cast<float>(object.light.y);
    ray.dir_z = static_cast<float>(object.light.z);
    ray.tnear = static_cast<float>(clearance_m);
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = ~0u;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(object.solid->scene, &context, &ray);
    return ray.tfar < 0;  // Embree's mark of a hit
  }

  // Objects that may keep light from this one: all whose box, drawn out to the end of its shadow, meets its box.
  static std::vector<const Placed*> casters_on(const Placed& object, const std::vector<Placed>& objects) {
    constexpr double slack = 1e-6;  // more than rounding
    std::vector<const Placed*> casters;
    for (const Placed& other : objects) {
      const double reach = (other.high.z - object.low.z) * climb;
      if (reach >= 0 && object.low.x <= other.high.x - reach * light.x + slack &&
          object.high.x >= other.low.x - slack && object.low.y <= other.high.y - reach * light.y + slack &&
          object.high.y >= other.low.y - slack)
        casters.push_back(&other);
    }
    return casters;
  }

  // Colours of the pixels that show this object; how many there are.
  int paint(const Placed& object, const std::vector<Placed>& objects, Observation& seen) const {
    const std::vector<const Placed*> casters = casters_on(object, objects);
    int visible = 0;
    for (int row = object.area.first_row; row <= object.area.last_row; ++row)
      for (int column = object.area.first_column; column <= object.area.last_column;) {
        const int pixel = row * columns + column;
        if (seen.ids[pixel] != object.id) {
          ++column;
          continue;
        }
        int end = column + 1;  // of the pixels that look alike
        while (end <= object.area.last_column && seen.ids[row * columns + end] == object.id &&
               looks[row * columns + end] == looks[pixel])
          ++end;
        paint_run(object, row, column, end, casters, &seen.rgb[3 * pixel]);
        visible += end - column;
        column = end;
      }
    return visible;
  }

  // Colours of pixels of one row, columns `first` to before `end`, which show the object and look alike.
  void paint_run(const Placed& object, int row, int first, int end, const std::vector<const Placed*>& casters,
                 std::uint8_t* rgb) const {
    const double* const heights = &heights_m[row * columns];
    const double x = Workspace::x_min + (row + 0.5) * row_m;
    const auto y = [](int column) { return Workspace::y_min + (column + 0.5) * column_m; };
    const auto [lit, plane] = looks[row * columns + first];
    const Vec3 u = object.axes[plane == Plane::side_xz ? 0 : 1],
               v = plane == Plane::top ? object.axes[0] : -1 * object.axes[2], origin = object.position;
    const Texture& texture = *object.texture;
    std::array<int, columns> texels, brightness;  // loops of their own, so that the work of several pixels overlaps
    for (int column = first; column < end; ++column) {
      const Vec3 local = Vec3{x, y(column), heights[column]} - origin;
      texels[column] = texture.texel(dot(v, local)) * Texture::size + texture.texel(dot(u, local));
    }
    std::fill(&brightness[first], &brightness[end - 1] + 1, lit);
    if (lit > ambient)
      for (const Placed* caster : casters)
        for (int column = first; column < end; ++column)
          if (brightness[column] == lit && shades(*caster, x, y(column), heights[column])) brightness[column] = ambient;
    for (int column = first; column < end; ++column, rgb += 3)
      paint_pixel(rgb, texture.pixels[texels[column]], brightness[column]);
  }
};

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;

Observation Renderer::render(const std::vector<VisibleObject>& objects, Ground ground) {
  std::array<bool, 256> taken{true};  // 0 is the table's
  std::vector<Placed> placed;
  for (const VisibleObject& object : objects) {
    if (taken[object.instance_id])
      throw InputError(fmt::format("instance id {}: expected 1 to 255, each once", object.instance_id));
    taken[object.instance_id] = true;
    placed.push_back(impl_->place(object));
  }

  const Table& empty = table(ground);
  Observation seen{Workspace::picture, empty.in_light, std::vector<std::uint8_t>(pixels), {}};
  for (const Placed& object : placed) impl_->clear(object.area);
  for (const Placed& object : placed) impl_->draw(object, seen);
  for (const Placed& object : placed) impl_->shade_table(object, empty, seen);
  for (std::size_t i = 0; i < objects.size(); ++i)
    seen.instances.push_back(
        {objects[i].instance_id, objects[i].object_type, objects[i].texture, impl_->paint(placed[i], placed, seen)});
  return seen;
}

}  // namespace lgabench::tabletop
