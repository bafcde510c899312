#include <lgabench/learning/stations.hpp>

#include <algorithm>

namespace lgabench {
namespace {

template <typename Distance>
std::size_t least_of(const Stations& stations, const Distance& distance) {
  const auto nearer = [&](const Stations::Station& a, const Stations::Station& b) { return distance(a) < distance(b); };
  return static_cast<std::size_t>(std::min_element(stations.all.begin(), stations.all.end(), nearer) -
                                  stations.all.begin());
}

}  // namespace

std::size_t nearest_station(const Stations& stations, Vec2 seen) {
  return least_of(stations, [&](const Stations::Station& one) { return norm(one.seen - seen); });
}

std::size_t station_of(const Stations& stations, const Action& action) {
  return least_of(stations, [&](const Stations::Station& one) {
    double squares = 0;
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      const double away = action[stations.numbers[i]] - one.values[i];
      squares += away * away;
    }
    return squares;
  });
}

Action led_to(const Stations& stations, std::size_t station, Action action) {
  const std::vector<double>& values = stations.all[station].values;
  for (std::size_t i = 0; i < values.size(); ++i) action[stations.numbers[i]] = values[i];
  return action;
}

}  // namespace lgabench
