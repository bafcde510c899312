// A camera that stands elsewhere, in its picture's plane; it looks the same way.
#include <lgabench/core/perturbations.hpp>

namespace lgabench::perturbations {

PerturbationAxis camera_shift() {
  PerturbationAxis axis{"camera_shift",
                        {"1 cm", "2.5 cm", "5 cm", "10 cm"},
                        {EpisodePart::rgb, EpisodePart::ids},
                        {EpisodePart::instances}};
  axis.look = [](View& view, const Scene&, int level, RandomStream stream) {
    constexpr std::array metres{.01, .025, .05, .1};
    view.shift_m = rotated({metres.at(static_cast<std::size_t>(level - 1)), 0}, stream.uniform(0, 2 * pi));
  };
  return axis;
}

}  // namespace lgabench::perturbations
