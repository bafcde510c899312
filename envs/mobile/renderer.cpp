#include <mobile/renderer.hpp>

#include <cstring>

#include <common/raster.hpp>
#include <common/solids.hpp>
#include <mobile/receivers.hpp>

namespace lgabench::mobile {
namespace {

constexpr Rgb floor_colour{150, 146, 140}, wall_colour{205, 208, 212};
constexpr double nearest_m = .05;  // what is nearer to the eye's plane is not drawn

// A solid in this picture.
struct Placed : PlacedSolid {
  using PlacedSolid::PlacedSolid;
  const Texture* texture = nullptr;
  Rgb colour{};
  std::uint8_t id = 0;
  std::uint16_t shadow_bit = 0;  // in Observation::shadows
  std::vector<Vec2> seen_at;     // where the camera sees each vertex
  std::vector<double> nearness;  // one over its depth; 0 where it is not in front of the camera
  Area area{};                   // holds all that is seen of it
};

// Where the shadow of a point falls on the plane at that height.
Vec3 shadow_of(Vec3 p, const Light& light, double height_m) {
  const double way = (p.z - height_m) * light.climb;
  return {p.x - way * light.towards.x, p.y - way * light.towards.y, height_m};
}

}  // namespace

std::vector<VisibleObject> visible_objects(const Scene& scene) {
  std::vector<VisibleObject> objects;
  for (const SceneObject& o : scene.objects)
    objects.push_back({o.object_type,
                       o.texture,
                       {{o.position_m.x, o.position_m.y, table_top_m}, from_yaw(o.yaw_rad)},
                       o.instance_id,
                       o.scale});
  return objects;
}

struct Renderer::Impl {
  using Kind = Surface::Kind;

  const Camera usual;
  const PictureSize size;
  View view;
  Camera camera;  // in that view
  Light light;
  Solids solids;
  // The room without objects: what pixels show, in light (with the room's own shadows) and in an object's shadow.
  std::vector<Kind> room;
  std::vector<std::uint8_t> room_rgb, room_shaded;
  std::vector<double> room_nearness;
  // The picture in work: one over the depth of the nearest, and its look; ids of objects.
  std::vector<double> nearness;
  std::vector<Look> looks;
  std::vector<std::uint8_t> ids, shadow;  // shadow: all 0 between uses
  std::vector<Area> drawn;                // differs from the room, of the last picture

  explicit Impl(const Camera& from)
      : usual(from),
        size(from.size),
        camera(from),
        room(size.pixels()),
        room_rgb(3 * size.pixels()),
        room_shaded(3 * size.pixels()),
        room_nearness(size.pixels()),
        looks(size.pixels()),
        ids(size.pixels()),
        shadow(size.pixels()) {
    draw_room(nullptr);
  }

  std::size_t at(int row, int column) const { return static_cast<std::size_t>(row * size.columns + column); }

  void look_at(Placed& placed) const {
    Vec2 low{1e9, 1e9}, high{-1e9, -1e9};
    for (const Vec3& v : placed.vertices) {
      const double depth = camera.depth(v);
      const bool seen = depth > nearest_m;
      const Vec2 p = placed.seen_at.emplace_back(seen ? camera.at(v) : Vec2{});
      placed.nearness.push_back(seen ? 1 / depth : 0);
      if (!seen) continue;
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    placed.area = area_of(size, low, high);
  }

  Placed place(const VisibleObject& object) {
    const ObjectModel& model = model_of(object.object_type, object.scale);
    Placed placed(solids.of(model.body.name, model.mesh), object.pose, light);
    placed.texture = &texture(object.texture);
    placed.id = object.instance_id;
    look_at(placed);
    return placed;
  }

  // Calls seen(pixel, nearness, look) where a pixel's ray meets the solid from outside.
  template <typename Seen>
  void draw(const Placed& solid, const Seen& seen) const {
    for (std::size_t i = 0; i < solid.solid->normals.size(); ++i) {
      const auto [ia, ib, ic] = solid.solid->mesh->triangles[i];
      const double a = solid.nearness[ia], b = solid.nearness[ib], c = solid.nearness[ic];
      if (a == 0 || b == 0 || c == 0) continue;
      const Vec2 at_a = solid.seen_at[ia], at_b = solid.seen_at[ib], at_c = solid.seen_at[ic];
      const double area = doubled_area(at_a, at_b, at_c);
      if (area < least_area) continue;
      const Look look = look_of(solid.solid->normals[i], solid.towards_light, light.climb);
      fill(size, at_a, at_b, at_c, [&](int row, int begin, int end) {
        for (int column = begin; column < end; ++column) {
          const Vec2 p{row + 0.0, column + 0.0};
          const double of_b = cross(at_a - at_c, p - at_c) / area, of_c = cross(at_b - at_a, p - at_a) / area;
          seen(at(row, column), a + of_b * (b - a) + of_c * (c - a), look);
        }
      });
    }
  }

  // Marks in `shadow` what of a level surface lies in the solid's shadow; the pixels of other surfaces as well.
  Area cast_shadow(const Placed& solid, double height_m) {
    Vec2 low{1e9, 1e9}, high{-1e9, -1e9};
    std::vector<Vec2> points;
    for (const Vec3& v : solid.vertices) {
      const Vec3 on_plane = shadow_of(v, light, height_m);
      if (camera.depth(on_plane) <= nearest_m) return {0, -1, 0, -1};
      const Vec2 p = points.emplace_back(camera.at(on_plane));
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    for (const auto& [a, b, c] : solid.solid->mesh->triangles)
      fill(size, points[a], points[b], points[c], [this](int row, int begin, int end) {
        std::memset(&shadow[at(row, begin)], 1, static_cast<std::size_t>(end - begin));
      });
    return area_of(size, low, high);
  }

  template <typename Visit>
  void for_each_pixel(const Area& area, const Visit& visit) const {
    for (int row = area.first_row; row <= area.last_row; ++row)
      for (int column = area.first_column; column <= area.last_column; ++column) visit(at(row, column));
  }

  // Calls dark(pixel) where the solid keeps the light from floor or table.
  template <typename Dark>
  void shade_room(const Placed& solid, const Dark& dark) {
    for (const auto& [kind, height_m] : {std::pair{Kind::floor, 0.}, std::pair{Kind::table_top, table_top_m}}) {
      if (solid.low.z < height_m - 1e-3) continue;
      for_each_pixel(cast_shadow(solid, height_m), [&, k = kind](std::size_t pixel) {
        if (shadow[pixel] && room[pixel] == k) dark(pixel);
        shadow[pixel] = 0;
      });
    }
  }

  // `cloth`: on the table; null: its own colour.
  void draw_room(const Texture* cloth) {
    room.assign(size.pixels(), Kind::nothing);
    room_nearness.assign(size.pixels(), 0);
    std::vector<Rgb> colours(size.pixels(), wall_colour);
    std::vector<int> brightness(size.pixels(), 256);
    for (int row = 0; row < size.rows; ++row)
      for (int column = 0; column < size.columns; ++column) {
        const double down = -camera.ray(row, column).z;
        if (down < 1e-6) continue;
        room[at(row, column)] = Kind::floor;
        room_nearness[at(row, column)] = down / camera.eye.z;
        colours[at(row, column)] = floor_colour;
      }
    std::vector<Placed> placed;
    for (const Furniture& thing : furniture()) {
      Placed& solid = placed.emplace_back(solids.of(thing.name, thing.mesh), Pose{}, light);
      solid.colour = thing.colour;
      look_at(solid);
      draw(solid, [&](std::size_t pixel, double near, const Look& look) {
        if (near <= room_nearness[pixel]) return;
        room_nearness[pixel] = near;
        room[pixel] = thing.name == "table" && look.plane == Plane::top ? Kind::table_top : Kind::furniture;
        colours[pixel] = thing.colour;
        brightness[pixel] = look.brightness;
      });
    }
    for (int row = 0; cloth && row < size.rows; ++row)
      for (int column = 0; column < size.columns; ++column) {
        const std::size_t pixel = at(row, column);
        if (room[pixel] != Kind::table_top) continue;
        const Vec3 p = camera.eye + 1 / room_nearness[pixel] * camera.ray(row, column);
        colours[pixel] = cloth->at(p.y, p.x);
      }
    for (const Placed& solid : placed)
      shade_room(solid, [&](std::size_t pixel) {
        if (room[pixel] == Kind::floor) brightness[pixel] = ambient;
      });
    for (std::size_t i = 0; i < size.pixels(); ++i) {
      paint_pixel(&room_rgb[3 * i], colours[i], brightness[i]);
      paint_pixel(&room_shaded[3 * i], colours[i], ambient);
    }
    nearness = room_nearness;
    std::fill(ids.begin(), ids.end(), std::uint8_t{0});
    drawn.clear();
  }

  // Places the objects and finds what is nearest at each pixel.
  std::vector<Placed> trace(const std::vector<VisibleObject>& objects) {
    expect_drawable(objects);
    std::vector<Placed> placed;
    for (const VisibleObject& object : objects) placed.push_back(place(object));
    for (const Area& area : drawn)
      for_each_pixel(area, [&](std::size_t pixel) {
        nearness[pixel] = room_nearness[pixel];
        ids[pixel] = 0;
      });
    drawn.clear();
    for (const Placed& object : placed) {
      drawn.push_back(object.area);
      draw(object, [&](std::size_t pixel, double near, const Look& look) {
        if (near <= nearness[pixel]) return;
        nearness[pixel] = near;
        looks[pixel] = look;
        ids[pixel] = object.id;
      });
    }
    return placed;
  }

  // Whether what a pixel of the empty room shows has light to lose.
  bool room_lit(std::size_t pixel) const {
    return !std::equal(&room_rgb[3 * pixel], &room_rgb[3 * pixel] + 3, &room_shaded[3 * pixel]);
  }

  Vec3 point(int row, int column) const { return camera.eye + 1 / nearness[at(row, column)] * camera.ray(row, column); }

  // Colours of the pixels that show this object; how many there are.
  int paint(const Placed& object, const std::vector<Placed>& objects, Observation& seen) const {
    std::vector<const Placed*> casters;
    for (const Placed& other : objects)
      if (other.may_shade(object)) casters.push_back(&other);
    int visible = 0;
    for (int row = object.area.first_row; row <= object.area.last_row; ++row)
      for (int column = object.area.first_column; column <= object.area.last_column; ++column) {
        const std::size_t pixel = at(row, column);
        if (ids[pixel] != object.id) continue;
        ++visible;
        const auto [lit, plane] = looks[pixel];
        const Vec3 u = object.axes[plane == Plane::side_xz ? 0 : 1],
                   v = plane == Plane::top ? object.axes[0] : -1 * object.axes[2];
        const Vec3 p = point(row, column), local = p - object.position;
        int brightness = lit;
        for (std::size_t i = 0; i < casters.size() && brightness > ambient; ++i)
          if (casters[i]->shades(p)) brightness = ambient;
        if (!seen.shadows.empty() && lit > ambient)
          for (const Placed* caster : casters)
            if (caster->shades(p)) seen.shadows[pixel] |= caster->shadow_bit;
        paint_pixel(&seen.rgb[3 * pixel], object.texture->at(dot(u, local), dot(v, local)), brightness);
      }
    return visible;
  }
};

Renderer::Renderer(const Camera& camera) : impl_(std::make_unique<Impl>(camera)) {}
Renderer::~Renderer() = default;

void Renderer::look(const View& view) {
  if (view == impl_->view) return;
  const Texture* const cloth = view.table.empty() ? nullptr : &texture(view.table);
  impl_->view = view;
  impl_->camera = impl_->usual.in(view);
  impl_->light = Light{view.light};
  impl_->draw_room(cloth);
}

const Camera& Renderer::camera() const { return impl_->camera; }

Observation Renderer::render(const std::vector<VisibleObject>& objects, bool shadows) {
  std::vector<Placed> placed = impl_->trace(objects);
  Observation seen{impl_->size, impl_->room_rgb, impl_->ids, {}};
  if (shadows) {
    give_shadow_bits(placed);
    seen.shadows.resize(seen.ids.size());
  }
  for (const Placed& object : placed)
    impl_->shade_room(object, [&](std::size_t pixel) {
      if (seen.ids[pixel]) return;
      if (shadows && impl_->room_lit(pixel)) seen.shadows[pixel] |= object.shadow_bit;
      std::copy_n(&impl_->room_shaded[3 * pixel], 3, &seen.rgb[3 * pixel]);
    });
  for (std::size_t i = 0; i < objects.size(); ++i)
    seen.instances.push_back(
        {objects[i].instance_id, objects[i].object_type, objects[i].texture, impl_->paint(placed[i], placed, seen)});
  return seen;
}

std::vector<std::uint8_t> Renderer::ids(const std::vector<VisibleObject>& objects) {
  impl_->trace(objects);
  return impl_->ids;
}

Surface Renderer::surface(int row, int column) const {
  const std::size_t pixel = impl_->at(row, column);
  Surface seen{impl_->room[pixel], impl_->ids[pixel], {}};
  if (seen.instance_id != 0) seen.kind = Surface::Kind::object;
  if (seen.kind != Surface::Kind::nothing) seen.point_m = impl_->point(row, column);
  return seen;
}

}  // namespace lgabench::mobile
