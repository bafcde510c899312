#include <lgabench/abstraction/textualization.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include <lgabench/core/shadows.hpp>

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

}  // namespace

Observation imperfect_textualization(Observation observation, const FeatureSpace& space,
                                     const TextualizationNoise& noise, RandomStream stream) {
  expect_probability("label_noise", noise.label_noise);
  expect_probability("missed_segment", noise.missed_segment);
  std::array<bool, 256> missed{};
  for (Instance& instance : observation.instances) {
    confuse(instance.object_type, space.object_types, noise.label_noise, stream);
    confuse(instance.texture, space.textures, noise.label_noise, stream);
    missed[instance.id] = stream.uniform() < noise.missed_segment;
  }
  auto& table = observation.instances;
  const std::vector<Instance> before = table;
  table.erase(std::remove_if(table.begin(), table.end(), [&](const Instance& i) { return missed[i.id]; }), table.end());
  observation.shadows = shadows_of(observation.shadows, before, table);
  for (std::uint8_t& id : observation.ids)
    if (missed[id]) id = 0;
  return observation;
}

}  // namespace lgabench
