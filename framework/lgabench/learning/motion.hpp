// What demonstrations have in common once a point is taken. Private to learning/.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include <lgabench/core/action.hpp>

namespace lgabench {

/// What a scene offers to move relative to.
struct Places {
  Vec2 taken_m;
  std::optional<Vec2> second_m{};  // centroid of the second set
};

/// A demonstrated action, executable(), and where its scene had what.
struct Demonstrated {
  Action label;
  Places places;
  std::array<bool, 2> on_target;  // pose0, pose1
};

/// More than half have that pose on the target.
bool mostly_on_target(const std::vector<Demonstrated>& all, std::size_t pose);

/// Of each group the numbers of its demonstrations.
using Groups = std::vector<std::vector<std::size_t>>;
Groups one_group(const std::vector<Demonstrated>& all);
/// By the direction from pose0 to pose1: unit vectors within .15 of the group's first.
Groups by_push(const std::vector<Demonstrated>& all);

/// Means of the poses, on the table. @pre there is one.
Action mean_action(const std::vector<Action>& labels);

/// Each coordinate of the positions is the group's mean on the table, relative to the taken point or, where every
/// demonstration shows one, to the second set's centroid, whichever varies least (spreads below 1 mm are equal; of
/// equals the taken point where most demonstrated positions lie on the target, else the table). Rotations are means.
class Motion {
 public:
  /// `takes`: pose0 is the taken point. `second`: whether the second set's centroid is a frame. @pre no group is empty.
  Motion(const std::vector<Demonstrated>& all, const Groups& groups, bool takes, bool second);
  /// @pre `group` is one of those.
  Action act(const Places& places, std::size_t group) const;
  /// Largest root of the mean squared deviation of a coordinate of pose1 from its group's mean, in metres.
  double spread_m() const { return spread_m_; }

 private:
  enum class Frame { table, taken, second };
  using Positions = std::array<double, 4>;  // x, y of pose0, x, y of pose1
  using Frames = std::array<Frame, 4>;
  struct Means {
    Positions positions{};
    std::array<Quat, 2> rotations{Quat{0, 0, 0, 0}, Quat{0, 0, 0, 0}};  // not of unit length
    Vec2 second_m{};
  };

  static Frames all_in(Frame frame) { return {frame, frame, frame, frame}; }
  static Positions origins(const Frames& frames, const Places& places);
  static Positions positions(const Demonstrated& one, const Frames& frames);
  static Means means(const std::vector<Demonstrated>& all, const std::vector<std::size_t>& group, const Frames& frames);
  static Positions spread(const std::vector<Demonstrated>& all, const Groups& groups, const Frames& frames);

  bool takes_;
  Frames frames_;
  std::vector<Means> means_;  // of each group
  double spread_m_ = 0;
};

}  // namespace lgabench
