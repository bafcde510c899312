#include <lgabench/abstraction/goal_mask.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace lgabench {
namespace {

enum : std::uint8_t { unlisted = 2 };

// Looks every pixel's id up in a table of 0 (drop), 1 (keep) or unlisted.
void look_up(const Observation& observation, const std::array<std::uint8_t, 256>& kept,
             std::vector<std::uint8_t>& mask) {
  constexpr std::size_t pixels = std::size_t{Observation::rows} * Observation::columns;
  if (observation.ids.size() != pixels)
    throw InputError(fmt::format("observation: ids: expected {} pixels, got {}", pixels, observation.ids.size()));
  mask.resize(pixels);
  std::transform(observation.ids.begin(), observation.ids.end(), mask.begin(),
                 [&](std::uint8_t id) { return kept[id]; });
  const auto stray = std::find(mask.begin(), mask.end(), unlisted);
  if (stray != mask.end())
    throw InputError(fmt::format("observation: ids: expected an id of the instance table, got {}",
                                 observation.ids[static_cast<std::size_t>(stray - mask.begin())]));
}

}  // namespace

void goal_mask(const Observation& observation, const Selection& selection, std::vector<std::uint8_t>& mask) {
  std::array<std::uint8_t, 256> kept;
  kept.fill(unlisted);
  kept[0] = 0;
  for (const Instance& instance : observation.instances)
    kept[instance.id] = selection.keeps(instance.object_type, instance.texture);
  look_up(observation, kept, mask);
}

std::vector<std::uint8_t> goal_mask(const Observation& observation, const Selection& selection) {
  std::vector<std::uint8_t> mask;
  goal_mask(observation, selection, mask);
  return mask;
}

std::vector<std::uint8_t> object_mask(const Observation& observation) {
  std::vector<std::uint8_t> mask;
  object_mask(observation, mask);
  return mask;
}

void object_mask(const Observation& observation, std::vector<std::uint8_t>& mask) {
  std::array<std::uint8_t, 256> kept;
  kept.fill(1);
  kept[0] = 0;
  look_up(observation, kept, mask);
}

}  // namespace lgabench
