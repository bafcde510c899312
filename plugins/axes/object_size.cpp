// Things of another size: all of them smaller, or the target larger, as far as there is room.
#include <lgabench/core/perturbations.hpp>

#include <lgabench/core/environments.hpp>

namespace lgabench::perturbations {
namespace {

constexpr std::array down{.95, .9, .8, .67}, up{1.05, 1.1, 1.25, 1.5};

std::vector<double> larger(int level) { return {up.begin(), up.begin() + level}; }

}  // namespace

PerturbationAxis object_size() {
  PerturbationAxis axis{"object_size",
                        {"all x 0.95 or the target x 1.05", "x 0.9 or 1.1", "x 0.8 or 1.25", "x 0.67 or 1.5"},
                        {EpisodePart::physics, EpisodePart::rgb},
                        {EpisodePart::ids}};  // less than a pixel of a small thing
  axis.change = [](Scene scene, const Scenario& scenario, int level, RandomStream stream) {
    const EnvironmentType& environment = *scenario.environment;
    return stream.coin() ? environment.resized(std::move(scene), down.at(static_cast<std::size_t>(level - 1)))
                         : environment.with_larger_target(std::move(scene), larger(level));
  };
  axis.lacks = lacks_engine;
  axis.bodies = [](int level) {
    BodyVariants bodies{larger(level)};
    bodies.scales.insert(bodies.scales.begin(), {1, down.at(static_cast<std::size_t>(level - 1))});
    return bodies;
  };
  return axis;
}

}  // namespace lgabench::perturbations
