// A camera that is turned where it stands: to a side and up or down where it has perspective, else about its axis.
#include <lgabench/core/perturbations.hpp>

namespace lgabench::perturbations {

PerturbationAxis camera_turn() {
  PerturbationAxis axis{"camera_turn",
                        {"1 degree", "2 degrees", "4 degrees", "8 degrees"},
                        {EpisodePart::rgb, EpisodePart::ids},
                        {EpisodePart::instances}};
  axis.look = [](View& view, const Scene&, int level, RandomStream stream) {
    constexpr std::array degrees{1., 2., 4., 8.};
    view.turn_rad = rotated({degrees.at(static_cast<std::size_t>(level - 1)) * pi / 180, 0}, stream.uniform(0, 2 * pi));
  };
  return axis;
}

}  // namespace lgabench::perturbations
