// More things around the target: in an episode all uniform, or all near misses.
#include <lgabench/core/perturbations.hpp>

#include <fmt/format.h>

#include <lgabench/core/environments.hpp>

namespace lgabench::perturbations {

PerturbationAxis distractors() {
  PerturbationAxis axis{
      "distractors",
      {"1 more", "2 more", "3 more", "4 more"},
      {EpisodePart::objects, EpisodePart::physics, EpisodePart::rgb, EpisodePart::ids, EpisodePart::instances}};
  axis.change = [](Scene scene, const Scenario& scenario, int level, RandomStream stream) {
    const bool near_miss = stream.coin();
    return scenario.environment->with_distractors(scenario, std::move(scene), level, near_miss, stream);
  };
  axis.bodies = [](int level) { return BodyVariants{{1}, 1, 1, level}; };
  axis.lacks = [](const Scenario& scenario, int level) -> std::string {
    const int room = scenario.environment->room_for_distractors(scenario);
    return level <= room
               ? ""
               : fmt::format("expected scenes with room for {} more, {} has room for {}", level, scenario.id, room);
  };
  return axis;
}

}  // namespace lgabench::perturbations
