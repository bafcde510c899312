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

/// What one number of an action is, or of a state.
struct ActionNumber {
  std::string name, unit;  // "pose0.x", "m"; "" for a number without a unit
  double low, high;        // what is outside is clipped when the action is carried out
};

/// What one number of Observation::state is: its value lies within the bounds.
using StateNumber = ActionNumber;

/// Two numbers of an action that are a place in the picture; their bounds are the picture's edges.
struct PicturePlace {
  std::size_t down, across;  // indices: the number that grows down the rows, the one that grows across the columns
};

/// The few places that an action can lead to, if there are no others. Some of its numbers are then constants of the
/// place.
struct Stations {
  struct Station {
    Vec2 seen;                   // where a picture shows it: x down, y across, in the unit of the first place
    std::vector<double> values;  // one for each of `numbers`
  };
  std::vector<std::size_t> numbers;  // indices into an action's numbers
  std::vector<Station> all;          // empty: an action leads anywhere
};

/// What all actions of a task have in common. A value.
struct ActionSpace {
  std::vector<ActionNumber> numbers;
  /// Indices of numbers that are a unit vector together, which is normalised, not clipped. Four are a quaternion x, y,
  /// z, w; two are the cosine and the sine of an angle.
  std::vector<std::vector<std::size_t>> rotations;
  /// Where the action leads in the picture. It begins at the first place.
  std::vector<PicturePlace> places;
  Stations stations = {};

  std::size_t size() const { return numbers.size(); }
};

/// [{"name", "unit", "low", "high"}, ...]
Json to_json(const std::vector<ActionNumber>& numbers);
/// @throws InputError
std::vector<ActionNumber> read_numbers(const JsonReader& list);

/// {"numbers": [{"name", "unit", "low", "high"}, ...], "rotations": [[index, ...], ...], "places": [[down, across],
/// ...]}, and where there are stations "stations": {"numbers": [index, ...], "all": [{"seen": [down, across], "values":
/// [...]}, ...]}.
Json to_json(const ActionSpace& space);
/// @throws InputError for an index out of range, a rotation of neither two numbers nor four, or a station whose values
/// are not as many as its numbers.
ActionSpace read_action_space(const JsonReader& reader);

/// The action that is carried out: numbers clipped to their bounds, rotations normalised.
/// @throws MethodError for too few or too many numbers, one that is not finite as a float, or a rotation of norm below
/// 1e-6.
Action executable(const ActionSpace& space, const Action& action);

/// The action as files, labels and learners have it: rounded to float, with w >= 0 in quaternions. (q and -q turn
/// alike, and a regression target must be unique.) @pre `action` has as many numbers as the space.
Action as_stored(const ActionSpace& space, const Action& action);

/// Where a place of the action lies in a picture, clipped to the picture: x is its column and y its row, in pixels from
/// the picture's corner. @pre as for as_stored().
Vec2 in_picture(const ActionSpace& space, const PicturePlace& place, const Action& action, PictureSize picture);

}  // namespace lgabench
