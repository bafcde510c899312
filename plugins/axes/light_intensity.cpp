// Brighter or darker light: a gain on the whole picture. The lit table has 196 of 255, so that a high gain clips, as a
// sensor does.
#include <axes/pixels.hpp>
#include <lgabench/core/perturbations.hpp>

namespace lgabench::perturbations {

PerturbationAxis light_intensity() {
  PerturbationAxis axis{
      "light_intensity", {"x 1.08 or 0.8", "x 1.15 or 0.6", "x 1.22 or 0.45", "x 1.3 or 0.33"}, {EpisodePart::rgb}};
  axis.perceive = [](Observation seen, const Scenario&, int level, RandomStream stream) {
    constexpr std::array up{1.08, 1.15, 1.22, 1.3}, down{.8, .6, .45, .33};
    const double gain = (stream.coin() ? up : down).at(static_cast<std::size_t>(level - 1));
    multiply(seen, {gain, gain, gain});
    return seen;
  };
  return axis;
}

}  // namespace lgabench::perturbations
