// The smallest engine that fulfils the contract (docs/extending.md walks through it). Nothing has speed or weight:
// suction carries exactly, the blade moves what it meets just out of its way, and a released body lies on what is
// below it. Bodies never tilt, and each convex piece counts as an upright prism.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/error.hpp>
#include <lgabench/plugin/plugin.hpp>

namespace {

using namespace lgabench;
using Polygon = std::vector<Vec2>;  // convex, counter-clockwise

constexpr double time_step = .01;
constexpr double touch_m = 1e-5;  // nearer than this, bodies touch
constexpr double infinity = std::numeric_limits<double>::infinity();

double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

/// The convex hull of the points seen from above (Andrew's monotone chain).
Polygon convex_hull(const std::vector<Vec3>& points) {
  Polygon sorted, hull;
  for (const Vec3& p : points) sorted.push_back({p.x, p.y});
  std::sort(sorted.begin(), sorted.end(), [](Vec2 a, Vec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  for (const int side : {0, 1}) {
    const std::size_t start = hull.size();
    for (const Vec2 p : sorted) {
      while (hull.size() >= start + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();  // the other side begins with it
    if (side == 0) std::reverse(sorted.begin(), sorted.end());
  }
  return hull;
}

/// An upright prism: an outline seen from above, and the heights of its bottom and top.
struct Prism {
  Polygon outline;
  double bottom = 0, top = 0;
  Vec2 low{}, high{};  // of the outline's box, once placed
};

struct Model {
  std::vector<Prism> prisms;  // in the body's frame
  bool fixed = false;
};

Prism placed(Prism prism, const Pose& pose) {
  const double yaw = yaw_of(pose.rotation);
  prism.low = {infinity, infinity}, prism.high = {-infinity, -infinity};
  for (Vec2& p : prism.outline) {
    p = Vec2{pose.position_m.x, pose.position_m.y} + rotated(p, yaw);
    prism.low = {std::min(prism.low.x, p.x), std::min(prism.low.y, p.y)};
    prism.high = {std::max(prism.high.x, p.x), std::max(prism.high.y, p.y)};
  }
  prism.bottom += pose.position_m.z;
  prism.top += pose.position_m.z;
  return prism;
}

/// Calls visit(outward normal, gap) for each edge of `a`: how far `b` lies beyond that edge, negative where it
/// overlaps.
template <typename Visit>
void for_each_gap(const Polygon& a, const Polygon& b, const Visit& visit) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec2 edge = a[(i + 1) % a.size()] - a[i], normal = 1 / norm(edge) * Vec2{edge.y, -edge.x};
    double gap = infinity;
    for (const Vec2 p : b) gap = std::min(gap, dot(normal, p - a[i]));
    visit(normal, gap);
  }
}

/// The gap between two convex polygons; negative: how deep they overlap.
double separation(const Polygon& a, const Polygon& b) {
  double most = -infinity;
  const auto keep = [&](Vec2, double gap) { most = std::max(most, gap); };
  for_each_gap(a, b, keep);
  for_each_gap(b, a, keep);
  return most;
}

/// How far `b` must go along the unit vector `way` until it no longer overlaps `a`, which it does now.
double way_out(const Polygon& a, const Polygon& b, Vec2 way) {
  double least = infinity;
  const auto along = [&](Vec2 direction) {
    return [&least, direction](Vec2 normal, double gap) {
      const double speed = dot(normal, direction);  // at which this gap grows
      if (speed > 1e-9) least = std::min(least, -gap / speed);
    };
  };
  for_each_gap(a, b, along(way));
  for_each_gap(b, a, along(-1.0 * way));
  return least;
}

bool beside(const Prism& a, const Prism& b) { return a.bottom < b.top - touch_m && b.bottom < a.top - touch_m; }

/// Whether two boxes, seen from above, are farther apart than touch_m: most pairs are, and need no further look.
bool far_apart(const Prism& a, const Prism& b) {
  return a.low.x > b.high.x + touch_m || b.low.x > a.high.x + touch_m || a.low.y > b.high.y + touch_m ||
         b.low.y > a.high.y + touch_m;
}

bool touch(const Prism& a, const Prism& b) {
  return !far_apart(a, b) && a.bottom < b.top + touch_m && b.bottom < a.top + touch_m &&
         separation(a.outline, b.outline) < touch_m;
}

/// Calls visit(a, b) for each pair of prisms, one of each.
template <typename Visit>
void for_each_pair(const std::vector<Prism>& a, const std::vector<Prism>& b, const Visit& visit) {
  for (const Prism& p : a)
    for (const Prism& q : b) visit(p, q);
}

Pose operator*(const Pose& a, const Pose& b) {
  return {a.position_m + rotated(b.position_m, a.rotation), a.rotation * b.rotation};
}
Pose inverse(const Pose& p) {
  const Quat back{-p.rotation.x, -p.rotation.y, -p.rotation.z, p.rotation.w};
  return {rotated(-1.0 * p.position_m, back), back};
}

const Pose& finite(const Pose& pose) {
  const Vec3& p = pose.position_m;
  const Quat& q = pose.rotation;
  if (!std::isfinite(p.x + p.y + p.z + q.x + q.y + q.z + q.w)) throw EngineError("kinematic: expected finite numbers");
  return pose;
}

class KinematicWorld final : public PhysicsWorld {
 public:
  void load(const std::vector<BodyModel>& models, int bodies) override {
    if (most_bodies_ > 0) throw EngineError("kinematic: load() is called once");
    for (const BodyModel& m : models) {
      Model model{{}, m.fixed};
      for (const ConvexPiece& piece : m.pieces) {
        Prism prism{convex_hull(piece.corners_m), infinity, -infinity};
        if (prism.outline.size() < 3) throw EngineError("kinematic: \"" + m.name + "\" has a piece without an area");
        for (const Vec3& c : piece.corners_m) {
          prism.bottom = std::min(prism.bottom, c.z);
          prism.top = std::max(prism.top, c.z);
        }
        model.prisms.push_back(std::move(prism));
      }
      models_.push_back(std::move(model));
    }
    most_bodies_ = static_cast<std::size_t>(bodies);
  }

  void reset(const std::vector<BodyPlacement>& placements) override {
    if (most_bodies_ == 0) throw EngineError("kinematic: reset() before load()");
    if (placements.size() > most_bodies_) throw EngineError("kinematic: more bodies than load() was told");
    std::vector<Body> bodies;
    for (const BodyPlacement& p : placements) {
      const auto index = static_cast<std::size_t>(p.model);
      if (p.model < 0 || index >= models_.size()) throw EngineError("kinematic: no model " + std::to_string(p.model));
      bodies.push_back({&models_[index], finite(p.pose), {}});
      move(bodies.back(), p.pose);
      bodies.back().moved = false;
    }
    bodies_ = std::move(bodies);
    grip_.reset();
    spatula_.reset();
  }

  double time_step_s() const override { return time_step; }

  void step() override {
    if (grip_) move(bodies_[grip_->body], grip_->target * grip_->to_body);
    if (spatula_) {
      const Vec3 way = spatula_->target.position_m - spatula_->pose.position_m;
      spatula_->pose = spatula_->target;
      if (norm(Vec2{way.x, way.y}) > 0) push_aside({blade()}, {way.x, way.y}, bodies_.size());
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const bool held = grip_ && grip_->body == i;
      if (!held && !bodies_[i].model->fixed) lay_down(i, bodies_[i].pose.position_m.z);
    }
  }

  Pose pose(int body) const override { return bodies_[index_of(body)].pose; }

  // A body's box alone: it has neither mass nor friction.
  std::optional<BodyPhysics> physics(int body) const override {
    BodyPhysics box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const Prism& prism : bodies_[index_of(body)].prisms) {
      box.low_m = {std::min(box.low_m.x, prism.low.x), std::min(box.low_m.y, prism.low.y),
                   std::min(box.low_m.z, prism.bottom)};
      box.high_m = {std::max(box.high_m.x, prism.high.x), std::max(box.high_m.y, prism.high.y),
                    std::max(box.high_m.z, prism.top)};
    }
    return box;
  }

  // Contacts of bodies that moved since reset() alone: the others rest.
  std::vector<Contact> contacts() const override {
    std::vector<Contact> found;
    const auto touching = [](const std::vector<Prism>& a, const std::vector<Prism>& b) {
      bool any = false;
      for_each_pair(a, b, [&](const Prism& p, const Prism& q) { any = any || touch(p, q); });
      return any;
    };
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const int name = static_cast<int>(i);
      if (spatula_ && touching({blade()}, bodies_[i].prisms)) found.push_back({spatula_body, name});
      if (bodies_[i].moved && bodies_[i].pose.position_m.z < touch_m) found.push_back({table_body, name});
      for (std::size_t k = 0; k < i; ++k)
        if ((bodies_[i].moved || bodies_[k].moved) && touching(bodies_[i].prisms, bodies_[k].prisms))
          found.push_back({static_cast<int>(k), name});
    }
    return found;
  }

  int cast_down(Vec2 point, double& height_m) const override {
    int hit = no_body;
    height_m = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      for (const Prism& prism : bodies_[i].prisms)
        if (prism.top > height_m && separation(prism.outline, {point, point + Vec2{1e-9, 0}}) <= 0) {
          height_m = prism.top;
          hit = static_cast<int>(i);
        }
    return hit;
  }

  void grip(int body, const Pose& gripper) override {
    const std::size_t i = index_of(body);
    if (bodies_[i].model->fixed) throw EngineError("kinematic: a fixed body cannot be gripped");
    grip_ = Grip{i, inverse(finite(gripper)) * bodies_[i].pose, gripper};
  }

  void move_gripper(const Pose& gripper) override {
    if (!grip_) throw EngineError("kinematic: the gripper moves only while it holds a body");
    grip_->target = finite(gripper);
  }

  void release() override {
    if (!grip_) return;
    const std::size_t body = grip_->body;
    grip_.reset();
    lay_down(body, infinity);  // on top of whatever it was let down into
  }

  void place_spatula(Vec3 size_m, const Pose& pose) override { spatula_ = Spatula{size_m, finite(pose), pose}; }
  void move_spatula(const Pose& pose) override {
    if (!spatula_) throw EngineError("kinematic: the spatula moves only while it is placed");
    spatula_->target = finite(pose);
  }
  void remove_spatula() override { spatula_.reset(); }

 private:
  struct Body {
    const Model* model;
    Pose pose;
    std::vector<Prism> prisms;  // where they are now
    bool moved = false;         // since reset()
  };
  struct Grip {
    std::size_t body;
    Pose to_body;  // from the gripper to the body
    Pose target;   // of the gripper, after the next step
  };
  struct Spatula {
    Vec3 size_m;
    Pose pose, target;
  };

  std::size_t index_of(int body) const {
    if (body < 0 || static_cast<std::size_t>(body) >= bodies_.size())
      throw EngineError("kinematic: no body " + std::to_string(body) + " is placed");
    return static_cast<std::size_t>(body);
  }

  static void move(Body& body, const Pose& pose) {
    body.pose = pose;
    body.moved = true;
    body.prisms.clear();
    for (const Prism& prism : body.model->prisms) body.prisms.push_back(placed(prism, pose));
  }

  Prism blade() const {
    const Vec2 half{spatula_->size_m.x / 2, spatula_->size_m.y / 2};
    return placed({{{-half.x, -half.y}, {half.x, -half.y}, {half.x, half.y}, {-half.x, half.y}},
                   -spatula_->size_m.z / 2,
                   spatula_->size_m.z / 2},
                  spatula_->pose);
  }

  /// Moves bodies that overlap `pusher` along `way` until they do not, and then what they meet. The pushing body,
  /// held bodies and fixed ones stay.
  void push_aside(const std::vector<Prism>& pusher, Vec2 way, std::size_t pushed_by) {
    const Vec2 unit = 1 / norm(way) * way;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      Body& body = bodies_[i];
      if (i == pushed_by || body.model->fixed || (grip_ && grip_->body == i)) continue;
      double out = 0;
      for_each_pair(pusher, body.prisms, [&](const Prism& p, const Prism& q) {
        if (beside(p, q) && separation(p.outline, q.outline) < -touch_m)
          out = std::max(out, way_out(p.outline, q.outline, unit));
      });
      if (out == 0) continue;
      move(body, {body.pose.position_m + Vec3{out * unit.x, out * unit.y, 0}, body.pose.rotation});
      push_aside(body.prisms, way, i);
    }
  }

  /// Lays the body on the highest thing under it that is not above `height_m`, plus a tolerance for bodies pressed in.
  void lay_down(std::size_t i, double height_m) {
    constexpr double pressed_m = 1e-3;
    Body& body = bodies_[i];
    double rest = 0;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      if (k == i || (grip_ && grip_->body == k)) continue;
      for_each_pair(body.prisms, bodies_[k].prisms, [&](const Prism& p, const Prism& q) {
        const double on_it = q.top - (p.bottom - body.pose.position_m.z);
        if (on_it > rest && on_it <= height_m + pressed_m && !far_apart(p, q) &&
            separation(p.outline, q.outline) < -touch_m)
          rest = on_it;
      });
    }
    if (rest == body.pose.position_m.z) return;
    const Vec3& p = body.pose.position_m;
    move(body, {{p.x, p.y, rest}, body.pose.rotation});
  }

  std::vector<Model> models_;
  std::size_t most_bodies_ = 0;
  std::vector<Body> bodies_;
  std::optional<Grip> grip_;
  std::optional<Spatula> spatula_;
};

}  // namespace

// Use LGABENCH_ENGINE for an engine whose bodies have mass and friction.
LGABENCH_KINEMATIC_ENGINE("kinematic", "0.1", "No dynamics: suction carries, a push moves aside, bodies lie flat",
                          KinematicWorld)
