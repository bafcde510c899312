#include <lgabench/learning/pointing.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <lgabench/core/random.hpp>

namespace lgabench {
namespace {

void put(const ActionSpace& actions, std::size_t place, Vec2 at, PictureSize size, Action& action) {
  const auto [down, across] = actions.places[place];
  const auto number = [&](std::size_t i, double share) {
    const ActionNumber& of = actions.numbers[i];
    action[i] = of.low + share * (of.high - of.low);
  };
  number(down, (at.x + .5) / size.rows);
  number(across, (at.y + .5) / size.columns);
}

class Pointing final : public Policy {
 public:
  Pointing(const ActionSpace& actions, bool may_stop) : actions_(actions), may_stop_(may_stop) {}

  Action act(const Observation& observation, const Instruction& instruction) override {
    const std::vector<Placed> visible = placed(observation);
    const auto without_places = [&visible](std::vector<std::uint8_t> ids) {
      for (const Placed& one : visible)
        if (is_place(one.instance.object_type))
          ids.erase(std::remove(ids.begin(), ids.end(), one.instance.id), ids.end());
      return ids;
    };
    std::vector<std::uint8_t> ids =
        without_places(grounded(instruction.selection.target, visible, observation.brought));
    if (ids.empty() && may_stop_) return {};
    if (ids.empty()) {
      for (const Placed& one : visible) ids.push_back(one.instance.id);
      ids = without_places(ids);
    }
    if (ids.empty()) throw MethodError("policy=point: expected an object in view, there is none");
    return pointed_at(observation, any_in_view(ids, observation), actions_);
  }

 private:
  ActionSpace actions_;
  bool may_stop_;
};

}  // namespace

Action pointed_at(const Observation& observation, std::uint8_t instance, const ActionSpace& actions) {
  const std::vector<Placed> visible = placed(observation);
  const auto find = [&visible](const auto& wanted) { return std::find_if(visible.begin(), visible.end(), wanted); };
  const auto object = find([instance](const Placed& one) { return one.instance.id == instance; });
  const auto goal = find([](const Placed& one) { return is_place(one.instance.object_type); });
  if (object == visible.end() || goal == visible.end() || actions.places.size() < 2)
    throw MethodError("policy=point: expected a task that brings an object in view to a place in view");
  Vec2 nearest;
  double least = std::numeric_limits<double>::infinity();
  const auto columns = static_cast<std::size_t>(observation.size.columns);
  for (std::size_t i = 0; i < observation.ids.size(); ++i) {
    if (observation.ids[i] != instance) continue;
    const std::size_t row = i / columns, column = i % columns;
    const Vec2 pixel{static_cast<double>(row), static_cast<double>(column)};
    const double away = std::hypot(pixel.x - object->row, pixel.y - object->column);
    if (away >= least) continue;
    least = away;
    nearest = pixel;
  }
  Action action;
  for (const ActionNumber& number : actions.numbers) action.push_back((number.low + number.high) / 2);
  for (const std::vector<std::size_t>& rotation : actions.rotations)
    for (std::size_t k = 0; k < rotation.size(); ++k)  // the cosine of no angle; a quaternion's w
      action[rotation[k]] = k == (rotation.size() == 2 ? 0 : rotation.size() - 1);
  put(actions, 0, nearest, observation.size, action);
  put(actions, 1, {goal->row + nearest.x - object->row, goal->column + nearest.y - object->column}, observation.size,
      action);
  return action;
}

std::uint8_t any_in_view(const std::vector<std::uint8_t>& ids, const Observation& observation) {
  std::string name = "pointing";
  for (const Placed& one : placed(observation))
    name += fmt::format("/{},{},{:.1f},{:.1f}", one.instance.object_type, one.instance.texture, one.row, one.column);
  return ids[RandomStream(name).below(static_cast<std::uint32_t>(ids.size()))];
}

std::unique_ptr<Policy> pointing_policy(const ActionSpace& actions, bool may_stop) {
  return std::make_unique<Pointing>(actions, may_stop);
}

}  // namespace lgabench
