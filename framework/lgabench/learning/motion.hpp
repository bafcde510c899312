// The motion that demonstrations share once a point is taken. Private to learning/.
#pragma once
#include <optional>
#include <vector>

#include <lgabench/core/action.hpp>
#include <lgabench/learning/archive.hpp>

namespace lgabench {

/// What a scene offers to move relative to.
struct Places {
  Vec2 taken_m;
  std::optional<Vec2> second_m{};  // centroid of the second set
};

/// A demonstrated action, executable(), and the points of its scene.
struct Demonstrated {
  Action label;
  Places places;
  std::vector<bool> on_target;  // of each of ActionSpace::places
};

/// A place of the action: x down the picture, y across it.
Vec2 place_of(const ActionSpace& actions, const Action& action, std::size_t place);

/// More than half have that place on the target.
bool mostly_on_target(const std::vector<Demonstrated>& all, std::size_t place);

/// Each group's demonstrations, by their numbers.
using Groups = std::vector<std::vector<std::size_t>>;
Groups one_group(const std::vector<Demonstrated>& all);
/// Groups by the direction from the first place to the second: unit vectors within .15 of the group's first. One group
/// where actions have no second place.
Groups by_push(const ActionSpace& actions, const std::vector<Demonstrated>& all);

/// Means of the numbers, executable(). @pre there is one.
Action mean_action(const ActionSpace& actions, const std::vector<Action>& labels);

/// Each coordinate of the places is the group's mean as it is, relative to the taken point or, where every
/// demonstration shows one, to the second set's centroid, whichever varies least (spreads below .001 are equal; of
/// equals the taken point where most demonstrated places lie on the target, else as it is). All else are means.
class Motion {
 public:
  /// `takes`: the first place is the taken point. `second`: whether the second set's centroid is a frame. @pre no group
  /// is empty, every action is of that space.
  Motion(const ActionSpace& actions, const std::vector<Demonstrated>& all, const Groups& groups, bool takes,
         bool second);
  /// A saved one.
  Motion(const ActionSpace& actions, Archive& archive) : actions_(actions), takes_(false) { learned(archive); }
  void learned(Archive& archive);
  std::size_t groups() const { return means_.size(); }
  /// @pre `group` is one of those.
  Action act(const Places& places, std::size_t group) const;
  /// Largest root of the mean squared deviation of a coordinate of the later places from its group's mean, in Field's
  /// unit.
  double spread_m() const { return spread_m_; }

 private:
  enum class Frame { none, taken, second };
  using Frames = std::vector<Frame>;  // of each number
  struct Means {
    Action values;  // rotations not of unit length
    Vec2 second_m{};
  };

  Frames all_in(Frame frame) const;
  double origin(std::size_t number, const Frames& frames, const Places& places) const;
  Means means(const std::vector<Demonstrated>& all, const std::vector<std::size_t>& group, const Frames& frames) const;
  std::vector<double> spread(const std::vector<Demonstrated>& all, const Groups& groups, const Frames& frames) const;

  ActionSpace actions_;
  bool takes_;
  Frames frames_;
  std::vector<Means> means_;  // of each group
  double spread_m_ = 0;
};

/// The motion and the mean action beside it, either of which may lack: to be written, or made of what is read.
void name_motion(std::optional<Motion>& motion, std::optional<Action>& mean, const ActionSpace& actions,
                 Archive& archive);

}  // namespace lgabench
