#include <lgabench/core/action.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace lgabench {
namespace {

constexpr double least_norm = 1e-6;

double norm_of(const Action& action, const std::vector<std::size_t>& rotation) {
  double squares = 0;
  for (const std::size_t i : rotation) squares += action[i] * action[i];
  return std::sqrt(squares);
}

double share(const ActionNumber& number, double value) {
  return (std::clamp(value, number.low, number.high) - number.low) / (number.high - number.low);
}

std::vector<double> numbers_of(const JsonReader& list) {
  std::vector<double> all;
  for (const JsonReader& number : list.elements()) all.push_back(number.number());
  return all;
}

}  // namespace

Json to_json(const std::vector<ActionNumber>& numbers) {
  Json all = Json::array();
  for (const ActionNumber& n : numbers)
    all.push_back({{"name", n.name}, {"unit", n.unit}, {"low", n.low}, {"high", n.high}});
  return all;
}

std::vector<ActionNumber> read_numbers(const JsonReader& list) {
  std::vector<ActionNumber> all;
  for (const JsonReader& number : list.elements())
    all.push_back({number.at("name").string(), number.at("unit").string(), number.at("low").number(),
                   number.at("high").number()});
  return all;
}

Json to_json(const ActionSpace& space) {
  Json places = Json::array();
  for (const PicturePlace& place : space.places) places.push_back({place.down, place.across});
  Json json{{"numbers", to_json(space.numbers)}, {"rotations", space.rotations}, {"places", places}};
  if (space.stations.all.empty()) return json;
  Json all = Json::array();
  for (const Stations::Station& one : space.stations.all)
    all.push_back({{"seen", {one.seen.x, one.seen.y}}, {"values", one.values}});
  json["stations"] = {{"numbers", space.stations.numbers}, {"all", all}};
  return json;
}

ActionSpace read_action_space(const JsonReader& reader) {
  ActionSpace space;
  space.numbers = read_numbers(reader.at("numbers"));
  const auto indices = [&](const JsonReader& list) {
    std::vector<std::size_t> all;
    for (const JsonReader& index : list.elements())
      all.push_back(static_cast<std::size_t>(index.integer(0, static_cast<long long>(space.size()) - 1)));
    return all;
  };
  for (const JsonReader& rotation : reader.at("rotations").elements()) {
    space.rotations.push_back(indices(rotation));
    if (const std::size_t n = space.rotations.back().size(); n != 2 && n != 4) rotation.fail("two numbers or four");
  }
  for (const JsonReader& place : reader.at("places").elements()) {
    const std::vector<std::size_t> pair = indices(place);
    if (pair.size() != 2) place.fail("two numbers");
    space.places.push_back({pair[0], pair[1]});
  }
  if (!reader.has("stations")) return space;
  const JsonReader stations = reader.at("stations");
  space.stations.numbers = indices(stations.at("numbers"));
  for (const JsonReader& station : stations.at("all").elements()) {
    const std::vector<double> seen = numbers_of(station.at("seen")), values = numbers_of(station.at("values"));
    if (seen.size() != 2) station.at("seen").fail("two numbers");
    if (values.size() != space.stations.numbers.size())
      station.at("values").fail(fmt::format("{} numbers", space.stations.numbers.size()));
    space.stations.all.push_back({{seen[0], seen[1]}, values});
  }
  return space;
}

Action executable(const ActionSpace& space, const Action& action) {
  if (action.size() != space.size())
    throw MethodError(fmt::format("action: expected {} numbers, got {}", space.size(), action.size()));
  Action done = action;
  for (std::size_t i = 0; i < done.size(); ++i) {
    const auto& [name, unit, low, high] = space.numbers[i];
    if (!std::isfinite(done[i])) throw MethodError(fmt::format("{}: expected a finite number, got {}", name, done[i]));
    if (std::abs(done[i]) > std::numeric_limits<float>::max())  // as it is recorded
      throw MethodError(fmt::format("{}: expected a number that a float can hold, got {}", name, done[i]));
    done[i] = std::clamp(done[i], low, high);
  }
  for (const auto& rotation : space.rotations) {
    const double norm = norm_of(action, rotation);
    if (norm < least_norm)
      throw MethodError(fmt::format("{}: expected a rotation of norm 1e-6 or more, got {}",
                                    space.numbers[rotation.front()].name, norm));
    for (const std::size_t i : rotation) done[i] = action[i] / norm;
  }
  return done;
}

Action as_stored(const ActionSpace& space, const Action& action) {
  Action kept = action;
  for (const auto& rotation : space.rotations)
    if (rotation.size() == 4 && kept[rotation[3]] < 0)
      for (const std::size_t i : rotation) kept[i] = -kept[i];
  for (double& value : kept) value = static_cast<float>(value);
  return kept;
}

Vec2 in_picture(const ActionSpace& space, const PicturePlace& place, const Action& action, PictureSize picture) {
  return {share(space.numbers[place.across], action[place.across]) * picture.columns,
          share(space.numbers[place.down], action[place.down]) * picture.rows};
}

}  // namespace lgabench
