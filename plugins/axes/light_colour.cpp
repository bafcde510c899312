// Light of another colour: each channel has a gain of its own; the level is the largest deviation from 1.
#include <axes/pixels.hpp>
#include <lgabench/core/perturbations.hpp>

#include <algorithm>
#include <cmath>

namespace lgabench::perturbations {

PerturbationAxis light_colour() {
  PerturbationAxis axis{"light_colour", {"10 %", "20 %", "30 %", "45 %"}, {EpisodePart::rgb}};
  axis.perceive = [](Observation seen, const Scenario&, int level, RandomStream stream) {
    constexpr std::array deviation{.1, .2, .3, .45};
    std::array<double, 3> factors;
    double largest = 0;
    for (double& way : factors) {
      way = stream.uniform(-1, 1);
      largest = std::max(largest, std::abs(way));
    }
    for (double& way : factors) way = 1 + deviation.at(static_cast<std::size_t>(level - 1)) * way / largest;
    multiply(seen, factors);
    return seen;
  };
  return axis;
}

}  // namespace lgabench::perturbations
