// Which of the stations of an action space is meant. Private to learning/.
#pragma once
#include <lgabench/core/action.hpp>

namespace lgabench {

/// The station seen nearest to a place of the picture, as a number of `all`. @pre there is one
std::size_t nearest_station(const Stations& stations, Vec2 seen);

/// The one that the action's numbers are nearest to. @pre there is one
std::size_t station_of(const Stations& stations, const Action& action);

/// The action, led to that station.
Action led_to(const Stations& stations, std::size_t station, Action action);

}  // namespace lgabench
