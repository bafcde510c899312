#include <mobile/receivers.hpp>

#include <algorithm>
#include <map>

#include <common/drawing.hpp>
#include <mobile/camera.hpp>
#include <mobile/plan.hpp>

namespace lgabench::mobile {
namespace {

struct Receiver {
  ObjectModel model;
  double floor_m, rim_m;  // as Vessel, of a receiver that stands on the plane
};

// Solids between two heights. The body's name is not the type's: a picture's furniture may be called alike.
struct ReceiverBuilder {
  ObjectModel made;

  explicit ReceiverBuilder(const std::string& type) {
    made.type = type;
    made.body = {"receiver/" + type, {}, 1, true};
  }
  void add(const Polygon& bottom, const Polygon& top, double z_low, double z_high) {
    ConvexPiece piece;
    for (const Vec2 p : bottom) piece.corners_m.push_back({p.x, p.y, z_low});
    for (const Vec2 p : top) piece.corners_m.push_back({p.x, p.y, z_high});
    made.body.pieces.push_back(std::move(piece));
    append(made.mesh, bottom, top, z_low, z_high);
    made.height_m = std::max(made.height_m, z_high);
  }
  void add(const Polygon& outline, double z_low, double z_high) { add(outline, outline, z_low, z_high); }

  Receiver with(const Polygon& outline, double floor_m, double rim_m) {
    made.outline = {outline};
    for (const Vec2 p : outline) made.radius_m = std::max(made.radius_m, norm(p));
    Vec2 high;
    for (const Vec2 p : outline) high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    made.size_m = 2 * high;
    return {made, floor_m, rim_m};
  }
};

// A bottom and four walls; they lean outwards by `lean`.
Receiver open_box(const std::string& type, double half, double wall, double floor, double rim, double lean) {
  ReceiverBuilder b(type);
  const double in = half - wall, foot = half - lean, foot_in = in - lean;
  b.add(rectangle(-foot, -foot, foot, foot), 0, floor);
  const auto wall_piece = [&](Vec2 low, Vec2 high) { return rectangle(low.x, low.y, high.x, high.y); };
  b.add(wall_piece({-foot, -foot}, {-foot_in, foot}), wall_piece({-half, -half}, {-in, half}), floor, rim);
  b.add(wall_piece({foot_in, -foot}, {foot, foot}), wall_piece({in, -half}, {half, half}), floor, rim);
  b.add(wall_piece({-foot_in, -foot}, {foot_in, -foot_in}), wall_piece({-in, -half}, {in, -in}), floor, rim);
  b.add(wall_piece({-foot_in, foot_in}, {foot_in, foot}), wall_piece({-in, in}, {in, half}), floor, rim);
  return b.with(rectangle(-half, -half, half, half), floor, rim);
}

// A foot, a stem and a plate with a rim.
Receiver plate_on_a_stand() {
  constexpr double radius = .11, rim = .012, top = .07, thick = .01, high = .092;
  ReceiverBuilder b("plate on a stand");
  b.add(disc(.055, {}, 24), 0, .01);
  b.add(disc(.016, {}, 16), .01, top);
  b.add(disc(radius - rim, {}, 32), top, top + thick);
  const auto foot = arc({}, radius - 2 * rim, radius - rim, 0, 360, 16),
             edge = arc({}, radius - rim, radius, 0, 360, 16);
  for (std::size_t i = 0; i < edge.size(); ++i) b.add(foot[i], edge[i], top, high);
  return b.with(disc(radius), top + thick, high);
}

const std::map<std::string, Receiver>& receivers() {
  static const std::map<std::string, Receiver> all{
      {"tray", open_box("tray", .115, .012, .012, .035, .012)},
      {"box", open_box("box", .11, .012, .012, .11, 0)},
      {"plate on a stand", plate_on_a_stand()},
  };
  return all;
}

}  // namespace

const std::vector<std::string>& receiver_types() {
  static const std::vector<std::string> all{"tray", "box", "plate on a stand"};
  return all;
}

bool is_receiver(const std::string& type) { return receivers().count(type) > 0; }

const ObjectModel& model_of(const std::string& type, double scale) {
  const auto found = receivers().find(type);
  return found == receivers().end() ? standing_model(type, scale) : found->second.model;
}

Vessel vessel_of(const std::string& type, Vec2 place) {
  const Receiver& receiver = receivers().at(type);
  const double outer = receiver.model.size_m.x;
  return {place, outer - 2 * Vessel::wall_m, table_top_m + receiver.floor_m, table_top_m + receiver.rim_m, table_top_m};
}

const ActionSpace& fetch_plans() {
  static const ActionSpace space = [] {
    ActionSpace made = plans();
    const Camera& camera = front_camera();
    made.stations.numbers = {2, 3, 4, 5, 6, 7};
    for (const Vec2 place : stations) {
      constexpr double middle_m = .04;  // of receivers, above the table
      const Vec2 seen = camera.at({place.x, place.y, table_top_m + middle_m});
      const Vec2 from = before(place);
      made.stations.all.push_back({{(seen.x + .5) / camera.size.rows, (seen.y + .5) / camera.size.columns},
                                   {from.x, from.y, 1, 0, place.x, place.y}});
    }
    return made;
  }();
  return space;
}

}  // namespace lgabench::mobile
