#include <lgabench/abstraction/textualization.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace lgabench {
namespace {

void expect_probability(const char* name, double p) {
  if (!(p >= 0 && p <= 1)) throw InputError(fmt::format("{}: expected a probability within [0, 1], got {}", name, p));
}

// With the given probability another of `names`. Two draws in either case: the next instance's stay its own.
void confuse(std::string& label, const std::vector<std::string>& names, double probability, RandomStream& stream) {
  const bool wrong = stream.uniform() < probability;
  const double which = stream.uniform();
  std::vector<std::string> others;
  std::copy_if(names.begin(), names.end(), std::back_inserter(others), [&](const auto& name) { return name != label; });
  if (wrong && !others.empty()) label = others[static_cast<std::size_t>(which * static_cast<double>(others.size()))];
}

using Missed = std::array<bool, 256>;  // by id

// Of what is missed, whose rows leave the table: the bits of those behind move up.
void forget_shadows(Observation& observation, const Missed& missed) {
  for (std::uint16_t& bits : observation.shadows) {
    std::uint16_t left = 0;
    for (std::size_t row = 0, to = 0; row < observation.instances.size(); ++row)
      if (!missed[observation.instances[row].id]) left |= static_cast<std::uint16_t>((bits >> row & 1U) << to++);
    bits = left;
  }
}

}  // namespace

Observation imperfect_textualization(Observation observation, const FeatureSpace& space,
                                     const TextualizationNoise& noise, RandomStream stream) {
  expect_probability("label_noise", noise.label_noise);
  expect_probability("missed_segment", noise.missed_segment);
  Missed missed{};
  for (Instance& instance : observation.instances) {
    confuse(instance.object_type, space.object_types, noise.label_noise, stream);
    confuse(instance.texture, space.textures, noise.label_noise, stream);
    missed[instance.id] = stream.uniform() < noise.missed_segment;
  }
  auto& table = observation.instances;
  if (!observation.shadows.empty()) forget_shadows(observation, missed);
  table.erase(std::remove_if(table.begin(), table.end(), [&](const Instance& i) { return missed[i.id]; }), table.end());
  for (std::uint8_t& id : observation.ids)
    if (missed[id]) id = 0;
  return observation;
}

}  // namespace lgabench
