#include <lgabench/abstraction/goal_mask.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace lgabench {
namespace {

using Table = std::array<std::uint8_t, 256>;  // instance id -> value of its pixels

constexpr std::uint8_t unlisted = 255;

// Looks every pixel's id up.
void look_up(const Observation& observation, const Table& values, std::vector<std::uint8_t>& mask) {
  const std::size_t pixels = observation.size.pixels();
  if (observation.ids.size() != pixels)
    throw InputError(fmt::format("observation: ids: expected {} pixels, got {}", pixels, observation.ids.size()));
  mask.resize(pixels);
  std::transform(observation.ids.begin(), observation.ids.end(), mask.begin(),
                 [&](std::uint8_t id) { return values[id]; });
  const auto stray = std::find(mask.begin(), mask.end(), unlisted);
  if (stray != mask.end())
    throw InputError(fmt::format("observation: ids: expected an id of the instance table, got {}",
                                 observation.ids[static_cast<std::size_t>(stray - mask.begin())]));
}

// Drops every instance of the role but the one whose first pixel comes first.
void keep_first(const Observation& observation, std::uint8_t role, Table& roles) {
  const auto first =
      std::find_if(observation.ids.begin(), observation.ids.end(), [&](std::uint8_t id) { return roles[id] == role; });
  if (first == observation.ids.end()) return;
  std::replace(roles.begin(), roles.end(), role, std::uint8_t{0});
  roles[*first] = role;
}

Table roles_of(const Observation& observation, const Selection& selection, Instances instances) {
  Table roles;
  roles.fill(unlisted);
  roles[0] = 0;
  for (const Instance& instance : observation.instances)
    roles[instance.id] =
        selection.second && selection.second->contains(instance.object_type, instance.texture) ? second_role : 0;
  if (selection.target.which || !selection.target.turns.empty()) {
    for (const std::uint8_t id : grounded(selection.target, observation)) roles[id] = target_role;
  } else {
    for (const Instance& instance : observation.instances)
      if (selection.target.belongs(instance.object_type, instance.texture)) roles[instance.id] = target_role;
  }
  if (instances == Instances::first)
    for (const std::uint8_t role : {target_role, second_role}) keep_first(observation, role, roles);
  return roles;
}

}  // namespace

void role_mask(const Observation& observation, const Selection& selection, std::vector<std::uint8_t>& mask,
               Instances instances) {
  look_up(observation, roles_of(observation, selection, instances), mask);
}

void goal_mask(const Observation& observation, const Selection& selection, std::vector<std::uint8_t>& mask,
               Instances instances) {
  Table kept = roles_of(observation, selection, instances);
  std::replace(kept.begin(), kept.end(), second_role, target_role);
  look_up(observation, kept, mask);
}

std::vector<std::uint8_t> goal_mask(const Observation& observation, const Selection& selection, Instances instances) {
  std::vector<std::uint8_t> mask;
  goal_mask(observation, selection, mask, instances);
  return mask;
}

std::vector<std::uint8_t> object_mask(const Observation& observation, const std::string& left_out) {
  std::vector<std::uint8_t> mask;
  object_mask(observation, mask, left_out);
  return mask;
}

void object_mask(const Observation& observation, std::vector<std::uint8_t>& mask, const std::string& left_out) {
  Table kept;
  kept.fill(1);
  kept[0] = 0;
  for (const Instance& instance : observation.instances)
    if (instance.object_type == left_out) kept[instance.id] = 0;
  look_up(observation, kept, mask);
}

}  // namespace lgabench
