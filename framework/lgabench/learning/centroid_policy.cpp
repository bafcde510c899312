#include <lgabench/learning/centroid_policy.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <lgabench/abstraction/goal_mask.hpp>

namespace lgabench {
namespace {

constexpr int rows = Observation::rows, columns = Observation::columns;
constexpr double alike = .15;          // unit vectors that are one direction
constexpr double least_spread = 1e-3;  // m: less is none

Vec2 centre_of(int row, int column) {
  return {Workspace::x_min + (row + .5) / rows * (Workspace::x_max - Workspace::x_min),
          Workspace::y_min + (column + .5) / columns * (Workspace::y_max - Workspace::y_min)};
}

Vec2 unit(Vec2 v) {
  const double length = norm(v);
  return length > 0 ? 1 / length * v : Vec2{};
}

// A sum of points, for their mean.
struct Centroid {
  Vec2 sum;
  int count = 0;
  void add(Vec2 point) {
    sum = sum + point;
    ++count;
  }
  Vec2 mean() const { return count > 0 ? 1.0 / count * sum : Vec2{}; }
};

// What the rule needs to know of a picture.
struct Scene {
  Vec2 taken_m;
  Vec2 to_avoid;  // unit vector; 0 without avoided pixels
};

// Finds the taken point in a picture. Buffers are kept: looking allocates nothing.
class Eye {
 public:
  Eye() : piece_of_(std::size_t{rows} * columns) { pending_.reserve(piece_of_.size()); }

  bool on_target(const std::vector<std::uint8_t>& roles, Vec2 point) const {
    const auto index = [](double from, double to, double value, int count) {
      return static_cast<int>(std::floor((value - from) / (to - from) * count));
    };
    return is_target(roles, index(Workspace::x_min, Workspace::x_max, point.x, rows),
                     index(Workspace::y_min, Workspace::y_max, point.y, columns));
  }

  // Of the pieces the nearest to `pose0`, the largest where it is null. None without target pixels.
  std::optional<Scene> look(const std::vector<std::uint8_t>& roles, const Vec2* pose0) {
    if (roles.size() != piece_of_.size())
      throw InputError(fmt::format("roles: expected {} pixels, got {}", piece_of_.size(), roles.size()));
    std::fill(piece_of_.begin(), piece_of_.end(), 0);
    Piece best;
    int pieces = 0;
    Centroid avoided;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        if (roles[index_of(row, column)] == second_role) avoided.add(centre_of(row, column));
        if (!is_target(roles, row, column) || piece_of_[index_of(row, column)] != 0) continue;
        const Piece piece = fill(roles, row, column, ++pieces, pose0);
        if (piece.rank < best.rank) best = piece;
      }
    if (best.id == 0) return std::nullopt;
    const Vec2 taken = onto(roles, best);
    return Scene{taken, avoided.count > 0 ? unit(avoided.mean() - taken) : Vec2{}};
  }

 private:
  struct Piece {
    int id = 0;
    Centroid pixels;
    double rank = std::numeric_limits<double>::infinity();  // the least is chosen
  };

  static std::size_t index_of(int row, int column) { return static_cast<std::size_t>(row * columns + column); }
  static bool is_target(const std::vector<std::uint8_t>& roles, int row, int column) {
    return row >= 0 && row < rows && column >= 0 && column < columns && roles[index_of(row, column)] == target_role;
  }

  // Numbers the pixels that hang together with this one, over edges and corners.
  Piece fill(const std::vector<std::uint8_t>& roles, int row, int column, int id, const Vec2* pose0) {
    Piece piece;
    piece.id = id;
    double nearest = std::numeric_limits<double>::infinity();
    const auto reach = [&](int r, int c) {
      if (!is_target(roles, r, c) || piece_of_[index_of(r, c)] != 0) return;
      piece_of_[index_of(r, c)] = id;
      pending_.push_back(r * columns + c);
      piece.pixels.add(centre_of(r, c));
      if (pose0) nearest = std::min(nearest, norm(*pose0 - centre_of(r, c)));
    };
    reach(row, column);
    while (!pending_.empty()) {
      const int r = pending_.back() / columns, c = pending_.back() % columns;
      pending_.pop_back();
      for (int y = r - 1; y <= r + 1; ++y)
        for (int x = c - 1; x <= c + 1; ++x) reach(y, x);
    }
    piece.rank = pose0 ? nearest : -piece.pixels.count;
    return piece;
  }

  // The piece's centroid, or the nearest of its pixels that have two more on every side; of all where none has.
  Vec2 onto(const std::vector<std::uint8_t>& roles, const Piece& piece) const {
    const Vec2 centroid = piece.pixels.mean();
    const Vec2 half_pixel = .5 * (centre_of(1, 1) - centre_of(0, 0));
    for (const int margin : {2, 0}) {
      Vec2 nearest = centroid;
      double least = std::numeric_limits<double>::infinity();
      for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
          if (piece_of_[index_of(r, c)] != piece.id || !within(roles, r, c, margin)) continue;
          const Vec2 away = centre_of(r, c) - centroid;
          if (std::abs(away.x) <= half_pixel.x && std::abs(away.y) <= half_pixel.y) return centroid;
          if (norm(away) < least) {
            least = norm(away);
            nearest = centre_of(r, c);
          }
        }
      if (std::isfinite(least)) return nearest;
    }
    return centroid;
  }

  static bool within(const std::vector<std::uint8_t>& roles, int row, int column, int margin) {
    for (int r = row - margin; r <= row + margin; ++r)
      for (int c = column - margin; c <= column + margin; ++c)
        if (!is_target(roles, r, c)) return false;
    return true;
  }

  std::vector<int> piece_of_;  // pixel -> 1, 2, ... in reading order; 0 off the target
  std::vector<int> pending_;
};

using Positions = std::array<double, 4>;  // x, y of pose0, x, y of pose1
using Frames = std::array<bool, 4>;       // relative to the taken point; else on the table

Positions at_taken(Vec2 taken) { return {taken.x, taken.y, taken.x, taken.y}; }

struct Demonstration {
  Action label;
  std::optional<Scene> scene;
  std::array<bool, 2> on_target;  // pose0, pose1

  Positions positions(const Frames& relative) const {
    const Vec2 p = label.pose0.position_m, q = label.pose1.position_m;
    Positions values{p.x, p.y, q.x, q.y};
    const Positions taken = at_taken(scene ? scene->taken_m : Vec2{});
    for (std::size_t i = 0; i < values.size(); ++i) values[i] -= relative[i] ? taken[i] : 0;
    return values;
  }
};

using Demonstrations = std::vector<Demonstration>;

struct Means {
  Positions positions{};
  std::array<Quat, 2> rotations;  // not of unit length

  Means(const Demonstrations& all, const Frames& relative) : rotations{Quat{0, 0, 0, 0}, Quat{0, 0, 0, 0}} {
    for (const Demonstration& d : all) {
      const Positions values = d.positions(relative);
      for (std::size_t i = 0; i < values.size(); ++i) positions[i] += values[i] / static_cast<double>(all.size());
      add(rotations[0], d.label.pose0.rotation);
      add(rotations[1], d.label.pose1.rotation);
    }
  }

 private:
  // q and -q turn alike: the one on the sum's side is added.
  static void add(Quat& sum, const Quat& q) {
    const double sign = sum.x * q.x + sum.y * q.y + sum.z * q.z + sum.w * q.w < 0 ? -1 : 1;
    sum = {sum.x + sign * q.x, sum.y + sign * q.y, sum.z + sign * q.z, sum.w + sign * q.w};
  }
};

Action action(const Positions& p, const std::array<Quat, 2>& rotations) {
  return executable({{{p[0], p[1]}, rotations[0]}, {{p[2], p[3]}, rotations[1]}});
}

// Demonstrations that are done alike.
struct Group {
  Demonstrations members;
  Means means;
  Vec2 to_avoid;  // mean

  Group(Demonstrations all, const Frames& relative) : members(std::move(all)), means(members, relative) {
    Centroid directions;
    for (const Demonstration& d : members) directions.add(d.scene->to_avoid);
    to_avoid = directions.mean();
  }
};

Vec2 push(const Demonstration& d) { return unit(d.label.pose1.position_m - d.label.pose0.position_m); }

std::vector<Demonstrations> by_push(const Demonstrations& all) {
  std::vector<Demonstrations> groups;
  for (const Demonstration& d : all) {
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&](const auto& group) { return norm(push(group.front()) - push(d)) < alike; });
    if (same == groups.end())
      groups.push_back({d});
    else
      same->push_back(d);
  }
  return groups;
}

// Root of the mean squared deviation of each coordinate from its group's mean.
Positions spread(const std::vector<Demonstrations>& groups, const Frames& relative) {
  Positions squares{};
  double count = 0;
  for (const Demonstrations& members : groups) {
    const Means means(members, relative);
    for (const Demonstration& d : members) {
      const Positions values = d.positions(relative);
      for (std::size_t i = 0; i < values.size(); ++i) squares[i] += std::pow(values[i] - means.positions[i], 2);
      ++count;
    }
  }
  for (double& value : squares) {
    value = std::sqrt(value / count);
    if (value < least_spread) value = 0;
  }
  return squares;
}

}  // namespace

struct CentroidRule::Impl {
  Eye eye;
  Demonstrations all;
  std::optional<Means> mean;  // on the table, of all
  std::vector<Group> groups;  // of those whose target is seen
  bool takes = false;         // pose0 is the taken point
  Frames relative{};

  const Group& nearest(const Scene& scene) const {
    const auto distance = [&](const Group& group) { return norm(group.to_avoid - scene.to_avoid); };
    double least = std::numeric_limits<double>::infinity();
    for (const Group& group : groups) least = std::min(least, distance(group));
    const Group* chosen = nullptr;
    for (const Group& group : groups)
      if (distance(group) <= least + alike && (!chosen || group.members.size() > chosen->members.size()))
        chosen = &group;
    return *chosen;
  }
};

CentroidRule::CentroidRule() : impl_(std::make_unique<Impl>()) {}
CentroidRule::~CentroidRule() = default;

void CentroidRule::add(const std::vector<std::uint8_t>& roles, const Action& label) {
  Impl& my = *impl_;
  const Action done = executable(label);
  const auto scene = my.eye.look(roles, &done.pose0.position_m);
  my.all.push_back(
      {done, scene, {my.eye.on_target(roles, done.pose0.position_m), my.eye.on_target(roles, done.pose1.position_m)}});
}

void CentroidRule::fit() {
  Impl& my = *impl_;
  if (my.all.empty()) throw MethodError("policy=centroid: expected at least one demonstration");
  my.mean.emplace(my.all, Frames{});
  Demonstrations seen;
  std::copy_if(my.all.begin(), my.all.end(), std::back_inserter(seen), [](const auto& d) { return d.scene; });
  if (seen.empty()) return;
  const auto mostly_on_target = [&](std::size_t pose) {
    const auto on = std::count_if(seen.begin(), seen.end(), [&](const auto& d) { return d.on_target[pose]; });
    return 2 * static_cast<std::size_t>(on) > seen.size();
  };
  my.takes = mostly_on_target(0);
  const std::vector<Demonstrations> groups = my.takes ? std::vector<Demonstrations>{seen} : by_push(seen);
  const Positions on_table = spread(groups, Frames{}), about_taken = spread(groups, {true, true, true, true});
  for (std::size_t i = 0; i < my.relative.size(); ++i)
    my.relative[i] = about_taken[i] < on_table[i] || (about_taken[i] == on_table[i] && mostly_on_target(i / 2));
  for (const Demonstrations& members : groups) my.groups.emplace_back(members, my.relative);
}

Action CentroidRule::act(const std::vector<std::uint8_t>& roles) {
  Impl& my = *impl_;
  const auto scene = my.eye.look(roles, nullptr);
  if (!scene || my.groups.empty()) return action(my.mean->positions, my.mean->rotations);
  const Means& means = my.nearest(*scene).means;
  const Positions taken = at_taken(scene->taken_m);
  Positions positions = means.positions;
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += my.relative[i] ? taken[i] : 0;
  if (my.takes) positions[0] = taken[0], positions[1] = taken[1];
  return action(positions, means.rotations);
}

}  // namespace lgabench
