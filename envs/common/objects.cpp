#include <common/objects.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include <common/shapes.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/shipped.hpp>

namespace lgabench::common {
namespace {

constexpr double density_kg_m3 = 400;                           // light wood
constexpr double least_mass_kg = 0.02, greatest_mass_kg = 0.3;  // thin and large types stay easy for the solvers

std::vector<Polygon> outline_of(const Drawing& drawing) {
  if (!drawing.outline.empty()) return drawing.outline;
  std::vector<Polygon> outline;
  for (const auto& part : drawing.parts) outline.push_back(part.bottom);
  return outline;
}

struct Box {
  Vec2 low, high;
};
Box bounding_box(const std::vector<Polygon>& polygons) {
  Box box{polygons[0][0], polygons[0][0]};
  for (const Polygon& polygon : polygons)
    for (const Vec2 p : polygon) {
      box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
      box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
    }
  return box;
}

ObjectModel make(const Shape& shape) {
  const Drawing drawing = shape.draw();
  const Box box = bounding_box(outline_of(drawing));
  const Vec2 centre = 0.5 * (box.low + box.high), size = box.high - box.low;
  // The drawing's up is the body's -x, its right the body's +y: a quarter turn.
  const auto to_body = [centre](Vec2 p) { return Vec2{centre.y - p.y, p.x - centre.x}; };
  const auto all_to_body = [&](Polygon polygon) {
    std::transform(polygon.begin(), polygon.end(), polygon.begin(), to_body);
    return polygon;
  };

  ObjectModel model;
  model.type = model.body.name = shape.type;
  model.size_m = {size.y, size.x};
  model.grasp_m = to_body(drawing.grasp);
  double volume_m3 = 0;
  for (const auto& part : drawing.parts) {
    const Polygon bottom = all_to_body(part.bottom), top = all_to_body(part.top);
    ConvexPiece piece;
    for (const Vec2 p : bottom) piece.corners_m.push_back({p.x, p.y, part.z_low});
    for (const Vec2 p : top) piece.corners_m.push_back({p.x, p.y, part.z_high});
    model.body.pieces.push_back(std::move(piece));
    append(model.mesh, bottom, top, part.z_low, part.z_high);
    model.height_m = std::max(model.height_m, part.z_high);
    volume_m3 += (area(bottom) + area(top)) / 2 * (part.z_high - part.z_low);
  }
  model.body.mass_kg = std::clamp(density_kg_m3 * volume_m3, least_mass_kg, greatest_mass_kg);
  for (const Polygon& polygon : outline_of(drawing)) model.outline.push_back(all_to_body(polygon));
  for (const Polygon& polygon : model.outline)
    for (const Vec2 p : polygon) model.radius_m = std::max(model.radius_m, norm(p));
  return model;
}

ObjectModel scaled(ObjectModel model, double scale) {
  model.body.name = fmt::format("{} x {}", model.body.name, scale);
  model.body.mass_kg = std::clamp(scale * scale * scale * model.body.mass_kg, least_mass_kg, greatest_mass_kg);
  for (ConvexPiece& piece : model.body.pieces)
    for (Vec3& corner : piece.corners_m) corner = scale * corner;
  for (Vec3& vertex : model.mesh.vertices_m) vertex = scale * vertex;
  for (Polygon& polygon : model.outline)
    for (Vec2& p : polygon) p = scale * p;
  model.size_m = scale * model.size_m;
  model.grasp_m = scale * model.grasp_m;
  model.height_m *= scale;
  model.radius_m *= scale;
  return model;
}

// Each type and size made once; a model stays where it is.
class Models {
 public:
  explicit Models(std::map<std::string, ObjectModel> types) : types_(std::move(types)) {}

  const ObjectModel* find(const std::string& type, double scale) {
    const auto found = types_.find(type);
    if (found == types_.end()) return nullptr;
    if (scale == 1) return &found->second;
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = scaled_.find({type, scale});
    return &(known != scaled_.end() ? known
                                    : scaled_.emplace(std::pair(type, scale), scaled(found->second, scale)).first)
                ->second;
  }

 private:
  const std::map<std::string, ObjectModel> types_;
  std::map<std::pair<std::string, double>, ObjectModel> scaled_;
  std::mutex mutex_;
};

}  // namespace

void append(Mesh& mesh, const Polygon& bottom, const Polygon& top, double z_low, double z_high) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size()), n = static_cast<std::uint32_t>(bottom.size());
  for (const Vec2 p : bottom) mesh.vertices_m.push_back({p.x, p.y, z_low});
  for (const Vec2 p : top) mesh.vertices_m.push_back({p.x, p.y, z_high});
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    mesh.triangles.push_back({first, first + i + 1, first + i});
    mesh.triangles.push_back({first + n, first + n + i, first + n + i + 1});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({first + i, first + j, first + n + j});
    mesh.triangles.push_back({first + i, first + n + j, first + n + i});
  }
}

const ObjectModel& object_model(const std::string& type, double scale) {
  static Models models([] {
    std::map<std::string, ObjectModel> all;
    for (const auto* kind : {&shapes(), &household_shapes()})
      for (const Shape& shape : *kind) all.emplace(shape.type, make(shape));
    return all;
  }());
  if (const ObjectModel* const found = models.find(type, scale)) return *found;
  throw InputError(fmt::format("object type \"{}\": expected one of: {}", type, fmt::join(object_types(), ", ")));
}

const ObjectModel& standing_model(const std::string& type, double scale) {
  static Models models([] {
    std::map<std::string, ObjectModel> all;
    for (const Shape& shape : standing_shapes()) all.emplace(shape.type, make(shape));
    return all;
  }());
  const ObjectModel* const found = models.find(type, scale);
  return found ? *found : object_model(type, scale);
}

const std::vector<std::string>& object_types() {
  static const std::vector<std::string> types = [] {
    std::vector<std::string> all;
    for (const auto* kind : {&shapes(), &household_shapes()})
      for (const Shape& shape : *kind) all.push_back(shape.type);
    return all;
  }();
  return types;
}

double covered_area_m2(const std::string& type) {
  static MadeOnce<double> areas;
  return areas.of(type, [&type] {
    constexpr int cells = 96;  // along each side of the bounding box: polygons may overlap
    const ObjectModel& model = object_model(type);
    int covered = 0;
    for (int i = 0; i < cells * cells; ++i) {
      const Vec2 point{((i % cells + .5) / cells - .5) * model.size_m.x,
                       ((i / cells + .5) / cells - .5) * model.size_m.y};
      covered += std::any_of(model.outline.begin(), model.outline.end(),
                             [point](const Polygon& polygon) { return contains(polygon, point); });
    }
    return model.size_m.x * model.size_m.y * covered / (cells * cells);
  });
}

void expect_drawable(const std::vector<VisibleObject>& objects) {
  std::array<bool, 256> taken{true};  // 0 is no object's
  for (const VisibleObject& object : objects) {
    if (taken[object.instance_id])
      throw InputError(fmt::format("instance id {}: expected 1 to 255, each once", object.instance_id));
    taken[object.instance_id] = true;
    const auto& [p, q] = object.pose;
    for (const double number : {p.x, p.y, p.z, q.x, q.y, q.z, q.w})
      if (!std::isfinite(number))
        throw InputError(fmt::format("instance {}: expected a finite pose, got {}", object.instance_id, number));
  }
}

std::vector<Polygon> placed_outline(const ObjectModel& model, Vec2 position_m, double yaw_rad) {
  return placed(model.outline, position_m, yaw_rad);
}

}  // namespace lgabench::common
