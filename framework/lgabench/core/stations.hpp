// Which of the stations of an action space is meant, and what stands there.
#pragma once
#include <cstdint>
#include <optional>

#include <lgabench/core/action.hpp>
#include <lgabench/core/method.hpp>

namespace lgabench {

/// The station seen nearest to a place of the picture, as a number of `all`. @pre there is one
std::size_t nearest_station(const Stations& stations, Vec2 seen);

/// The station that the action's numbers are nearest to. @pre there is one
std::size_t station_of(const Stations& stations, const Action& action);

/// The mean of an instance's pixels, in the numbers of a station's `seen`; none where it has no pixel.
/// @pre the space has a place
std::optional<Vec2> seen_at(const ActionSpace& actions, const Observation& seen, std::uint8_t instance);

/// The action, led to that station.
Action led_to(const Stations& stations, std::size_t station, Action action);

/// Id of the instance that the step's label leads to, where actions have stations: the visible one, beside the one
/// taken, whose middle is nearest to where the station is seen. None in other action spaces, or where the label is
/// none.
std::optional<std::uint8_t> receiving(const Step& step, const ActionSpace& actions);

}  // namespace lgabench
