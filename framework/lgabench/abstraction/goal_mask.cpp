#include <lgabench/abstraction/goal_mask.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace lgabench {
namespace {

enum : std::uint8_t { unlisted = 2 };

// Looks every pixel's id up in a table of 0 (drop), 1 (keep) or unlisted.
std::vector<std::uint8_t> look_up(const Observation& observation, const std::array<std::uint8_t, 256>& kept) {
  constexpr std::size_t pixels = std::size_t{Observation::rows} * Observation::columns;
  if (observation.ids.size() != pixels)
    throw InputError(fmt::format("observation: ids: expected {} pixels, got {}", pixels, observation.ids.size()));
  std::vector<std::uint8_t> mask(pixels);
  std::transform(observation.ids.begin(), observation.ids.end(), mask.begin(),
                 [&](std::uint8_t id) { return kept[id]; });
  const auto stray = std::find(mask.begin(), mask.end(), unlisted);
  if (stray != mask.end())
    throw InputError(fmt::format("observation: ids: expected an id of the instance table, got {}",
                                 observation.ids[static_cast<std::size_t>(stray - mask.begin())]));
  return mask;
}

}  // namespace

std::vector<std::uint8_t> goal_mask(const Observation& observation, const Selection& selection) {
  std::array<std::uint8_t, 256> kept;
  kept.fill(unlisted);
  kept[0] = 0;
  for (const Instance& instance : observation.instances)
    kept[instance.id] = selection.keeps(instance.object_type, instance.texture);
  return look_up(observation, kept);
}

std::vector<std::uint8_t> object_mask(const Observation& observation) {
  std::array<std::uint8_t, 256> kept;
  kept.fill(1);
  kept[0] = 0;
  return look_up(observation, kept);
}

}  // namespace lgabench
