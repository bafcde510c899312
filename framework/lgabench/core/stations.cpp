#include <lgabench/core/stations.hpp>

#include <algorithm>
#include <limits>

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

std::optional<Vec2> seen_at(const ActionSpace& actions, const Observation& seen, std::uint8_t instance) {
  Vec2 sum;
  int count = 0;
  const auto columns = static_cast<std::size_t>(seen.size.columns);
  for (std::size_t i = 0; i < seen.ids.size(); ++i) {
    if (seen.ids[i] != instance) continue;
    sum = sum + Vec2{static_cast<double>(i / columns) + .5, static_cast<double>(i % columns) + .5};
    ++count;
  }
  if (count == 0) return std::nullopt;
  const ActionNumber &down = actions.numbers[actions.places[0].down],
                     &across = actions.numbers[actions.places[0].across];
  const Vec2 mean = 1. / count * sum;
  return Vec2{down.low + mean.x / seen.size.rows * (down.high - down.low),
              across.low + mean.y / seen.size.columns * (across.high - across.low)};
}

Action led_to(const Stations& stations, std::size_t station, Action action) {
  const std::vector<double>& values = stations.all[station].values;
  for (std::size_t i = 0; i < values.size(); ++i) action[stations.numbers[i]] = values[i];
  return action;
}

std::optional<std::uint8_t> receiving(const Step& step, const ActionSpace& actions) {
  if (step.label.empty() || actions.stations.all.empty()) return std::nullopt;
  const Vec2 station = actions.stations.all[station_of(actions.stations, step.label)].seen;
  const std::optional<std::uint8_t> carried = taken(step, actions);
  std::optional<std::uint8_t> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const Instance& one : step.observation.instances) {
    const std::optional<Vec2> at = seen_at(actions, step.observation, one.id);
    if (!at || one.id == carried || is_place(one.object_type)) continue;
    if (const double away = norm(*at - station); away < least) {
      least = away;
      nearest = one.id;
    }
  }
  return nearest;
}

}  // namespace lgabench
