// Scenarios and scenes of the mobile environment, as its tests take them.
#pragma once
#include <string>

#include <mobile/sampler.hpp>

namespace lgabench::mobile {

inline const Scenario& scenario(const std::string& id) {
  static const Scenario bring = load_scenario("bring_fruit"), throw_away = load_scenario("throw_away_drink");
  return id == bring.id ? bring : throw_away;
}

inline Scene test_scene(const std::string& id, const std::string& arm, int index, std::uint64_t training_seed = 0) {
  return sample_scene(scenario(id), {layout, "test", arm, 0, {}, training_seed}, index);
}

}  // namespace lgabench::mobile
