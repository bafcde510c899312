// The camera looks straight down and the table is flat, so what it sees of the objects and the shadows that they throw
// on the table are triangles filled in the picture: exact at every pixel's centre, in double precision, hence the same
// on every processor. Only light on the objects themselves takes rays (Embree), and few points need one.
#include <tabletop/renderer.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include <common/objects.hpp>
#include <common/solids.hpp>
#include <common/textures.hpp>
#include <tabletop/raster.hpp>
#include <tabletop/zones.hpp>

namespace lgabench::tabletop {
namespace {

constexpr Rgb table_colour{196, 194, 190}, zone_colour{168, 184, 176};
// A solid in this picture.
struct Placed : PlacedSolid {
  using PlacedSolid::PlacedSolid;
  const Texture* texture = nullptr;
  std::uint8_t id = 0;
  std::uint16_t shadow_bit = 0;          // in Observation::shadows
  std::vector<Vec2> seen_at, shadow_at;  // where the camera sees each vertex, where its shadow falls
  Area area{}, shadow_area{};            // hold all that is seen of it, and its shadow on the table
};

// The table without objects.
struct Table {
  std::vector<std::uint8_t> in_light, in_shadow;

  Table(Ground ground, const View& view) : in_light(3 * pixels), in_shadow(3 * pixels) {
    const Camera camera(view);
    const Texture* const cloth = view.table.empty() ? nullptr : &texture(view.table);
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const Vec2 p = camera.point(row, column);
        const bool zone = ground == Ground::goal_zones && GoalZones::contains(p);
        const Rgb colour = zone ? zone_colour : cloth ? cloth->at(p.y, p.x) : table_colour;
        const std::size_t at = 3 * static_cast<std::size_t>(row * columns + column);
        paint_pixel(&in_light[at], colour, 256);
        paint_pixel(&in_shadow[at], colour, ambient);
      }
  }
};

// In the usual view.
const Table& usual_table(Ground ground) {
  static const Table plain(Ground::plain, {}), with_zones(Ground::goal_zones, {});
  return ground == Ground::plain ? plain : with_zones;
}

}  // namespace

std::vector<VisibleObject> visible_objects(const Scene& scene) {
  std::vector<VisibleObject> objects;
  for (const SceneObject& o : scene.objects)
    objects.push_back(
        {o.object_type, o.texture, {{o.position_m.x, o.position_m.y, 0}, from_yaw(o.yaw_rad)}, o.instance_id, o.scale});
  return objects;
}

struct Renderer::Impl {
  Solids solids;
  // The picture in work: where it shows what, in which light; how high the highest is at a pixel, and its look; valid
  // in the areas of objects.
  Camera camera;
  Light light;
  std::vector<double> heights_m;
  std::vector<Look> looks;
  std::vector<std::uint8_t> shadow;  // pixels to which an object keeps the light from the table; all 0 between pictures

  Impl() : heights_m(pixels), looks(pixels), shadow(pixels) {}

  Placed place(const VisibleObject& object) {
    const ObjectModel& model = object_model(object.object_type, object.scale);
    Placed placed(solids.of(model.body.name, model.mesh), object.pose, light);
    placed.texture = &texture(object.texture);
    placed.id = object.instance_id;
    placed.seen_at.reserve(placed.vertices.size());
    placed.shadow_at.reserve(placed.vertices.size());
    for (const Vec3& v : placed.vertices) {
      placed.seen_at.push_back(camera.at({v.x, v.y}));
      const double way = v.z * light.climb;
      placed.shadow_at.push_back(camera.at({v.x - way * light.towards.x, v.y - way * light.towards.y}));
    }
    placed.area = around(placed.seen_at);
    placed.shadow_area = around(placed.shadow_at);
    return placed;
  }

  static Area around(const std::vector<Vec2>& points) {
    Vec2 low{1e9, 1e9}, high{-1e9, -1e9};
    for (const Vec2 p : points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    return area_of(Workspace::picture, low, high);
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
      const Look look = look_of(object.solid->normals[i], object.towards_light, light.climb);
      const double a = object.vertices[ia].z, b = object.vertices[ib].z, c = object.vertices[ic].z;
      const auto keep_highest = [&](int pixel, double height) {
        if (height <= heights_m[pixel]) return;
        heights_m[pixel] = height;
        looks[pixel] = look;
        seen.ids[pixel] = object.id;
      };
      if (a == b && a == c) {  // as tops of prisms are, which most pixels show
        fill(Workspace::picture, at_a, at_b, at_c, [&](int row, int begin, int end) {
          for (int column = begin; column < end; ++column) keep_highest(row * columns + column, a);
        });
        continue;
      }
      const double area = doubled_area(at_a, at_b, at_c);
      fill(Workspace::picture, at_a, at_b, at_c, [&](int row, int begin, int end) {
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
      fill(Workspace::picture, object.shadow_at[a], object.shadow_at[b], object.shadow_at[c],
           [dark](int row, int begin, int end) {
             std::memset(dark + row * columns + begin, 1, static_cast<std::size_t>(end - begin));
           });
    const std::uint8_t *const ids = seen.ids.data(), *const shaded = table.in_shadow.data();
    std::uint8_t* const rgb = seen.rgb.data();
    const auto [first_row, last_row, first_column, last_column] = object.shadow_area;
    for (int row = first_row; row <= last_row; ++row)
      for (int pixel = row * columns + first_column; pixel <= row * columns + last_column; ++pixel) {
        if (dark[pixel] && !ids[pixel]) {
          std::copy_n(shaded + 3 * pixel, 3, rgb + 3 * pixel);
          if (!seen.shadows.empty()) seen.shadows[static_cast<std::size_t>(pixel)] |= object.shadow_bit;
        }
        dark[pixel] = 0;
      }
  }

  // Colours of the pixels that show this object; how many there are.
  int paint(const Placed& object, const std::vector<Placed>& objects, Observation& seen) const {
    std::vector<const Placed*> casters;
    for (const Placed& other : objects)
      if (other.may_shade(object)) casters.push_back(&other);
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
        if (!seen.shadows.empty()) note_shadows(row, column, end, casters, &seen.shadows[pixel]);
        visible += end - column;
        column = end;
      }
    return visible;
  }

  // Colours of pixels of one row, columns `first` to before `end`, which show the object and look alike.
  void paint_run(const Placed& object, int row, int first, int end, const std::vector<const Placed*>& casters,
                 std::uint8_t* rgb) const {
    const double* const heights = &heights_m[row * columns];
    const auto point = [&](int column) {
      const Vec2 p = camera.point(row, column);
      return Vec3{p.x, p.y, heights[column]};
    };
    const auto [lit, plane] = looks[row * columns + first];
    const Vec3 u = object.axes[plane == Plane::side_xz ? 0 : 1],
               v = plane == Plane::top ? object.axes[0] : -1 * object.axes[2], origin = object.position;
    const Texture& texture = *object.texture;
    std::array<int, columns> texels, brightness;  // loops of their own, so that the work of several pixels overlaps
    for (int column = first; column < end; ++column) {
      const Vec3 local = point(column) - origin;
      texels[column] = texture.texel(dot(v, local)) * Texture::size + texture.texel(dot(u, local));
    }
    std::fill(&brightness[first], &brightness[end - 1] + 1, lit);
    if (lit > ambient)
      for (const Placed* caster : casters)
        for (int column = first; column < end; ++column)
          if (brightness[column] == lit && caster->shades(point(column))) brightness[column] = ambient;
    for (int column = first; column < end; ++column, rgb += 3)
      paint_pixel(rgb, texture.pixels[texels[column]], brightness[column]);
  }

  // Which of them keep light from pixels of one row, columns `first` to before `end`, which look alike.
  void note_shadows(int row, int first, int end, const std::vector<const Placed*>& casters,
                    std::uint16_t* shadows) const {
    if (looks[row * columns + first].brightness <= ambient) return;
    for (const Placed* caster : casters)
      for (int column = first; column < end; ++column) {
        const Vec2 p = camera.point(row, column);
        if (caster->shades({p.x, p.y, heights_m[row * columns + column]}))
          shadows[column - first] |= caster->shadow_bit;
      }
  }
};

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;

Observation Renderer::render(const std::vector<VisibleObject>& objects, Ground ground, const View& view, bool shadows) {
  expect_drawable(objects);
  impl_->camera = Camera(view);
  impl_->light = Light{view.light};
  std::vector<Placed> placed;
  for (const VisibleObject& object : objects) placed.push_back(impl_->place(object));
  if (shadows) give_shadow_bits(placed);

  const std::optional<Table> in_view = view == View() ? std::nullopt : std::optional<Table>({ground, view});
  const Table& empty = in_view ? *in_view : usual_table(ground);
  Observation seen{Workspace::picture, empty.in_light, std::vector<std::uint8_t>(pixels), {}};
  if (shadows) seen.shadows.resize(pixels);
  for (const Placed& object : placed) impl_->clear(object.area);
  for (const Placed& object : placed) impl_->draw(object, seen);
  for (const Placed& object : placed) impl_->shade_table(object, empty, seen);
  for (std::size_t i = 0; i < objects.size(); ++i)
    seen.instances.push_back(
        {objects[i].instance_id, objects[i].object_type, objects[i].texture, impl_->paint(placed[i], placed, seen)});
  return seen;
}

}  // namespace lgabench::tabletop
