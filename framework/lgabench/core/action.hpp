// Actions as data: numbers, and the space that says what each of them means.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include <lgabench/core/geometry.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/observation.hpp>

namespace lgabench {

/// The numbers of one action, in the order of its environment's ActionSpace.
using Action = std::vector<double>;

/// What one of them is.
struct ActionNumber {
  std::string name, unit;  // "pose0.x", "m"; "" for a number without a unit
  double low, high;        // what is outside is clipped when the action is carried out
};

/// Two numbers that are a place in the picture: their bounds are its edges.
struct PicturePlace {
  std::size_t down, across;  // which of the numbers grows along the rows, which along the columns
};

/// Where an action can lead, if there are a few such places and no others: some of its numbers are then one of a few
/// constants, whichever place is meant.
struct Stations {
  struct Station {
    Vec2 seen;                   // where a picture shows it: x down, y across, as numbers of the first of places
    std::vector<double> values;  // of `numbers`
  };
  std::vector<std::size_t> numbers;  // which of an action's
  std::vector<Station> all;          // empty: an action leads anywhere
};

/// What all actions of a task have in common. A value.
struct ActionSpace {
  std::vector<ActionNumber> numbers;
  /// Numbers that are a unit vector together, and are not clipped but normalised: four are a quaternion x, y, z, w, two
  /// the cosine and the sine of an angle.
  std::vector<std::vector<std::size_t>> rotations;
  /// The first is where the action begins.
  std::vector<PicturePlace> places;
  Stations stations = {};

  std::size_t size() const { return numbers.size(); }
};

/// {"numbers": [{"name", "unit", "low", "high"}, ...], "rotations": [[index, ...], ...], "places": [[down, across],
/// ...]}; where there are stations {..., "stations": {"numbers": [index, ...], "all": [{"seen": [down, across],
/// "values":
/// [...]}, ...]}}
Json to_json(const ActionSpace& space);
/// @throws InputError for an index that there is not, a rotation of neither two numbers nor four, or a
/// station with another number of values than of numbers.
ActionSpace read_action_space(const JsonReader& reader);

/// The action that is carried out: numbers clipped to their bounds, rotations normalised.
/// @throws MethodError for another number of them, one that is not finite as a float, or a rotation of norm below 1e-6.
Action executable(const ActionSpace& space, const Action& action);

/// As files, labels and learners have it: rounded to float, quaternions with w >= 0, since q and -q turn alike and a
/// regression target must be unique. @pre as many numbers as the space has.
Action as_stored(const ActionSpace& space, const Action& action);

/// Where a place of the action lies in a picture: x its column, y its row, in pixels, 0 at the picture's corner; within
/// the picture. @pre as for as_stored().
Vec2 in_picture(const ActionSpace& space, const PicturePlace& place, const Action& action, PictureSize picture);

}  // namespace lgabench
