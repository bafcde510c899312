// Another lens: what the picture's middle shows is larger or smaller.
#include <lgabench/core/perturbations.hpp>

namespace lgabench::perturbations {

PerturbationAxis field_of_view() {
  PerturbationAxis axis{"field_of_view",
                        {"x or / 1.02", "1.05", "1.1", "1.2"},
                        {EpisodePart::rgb, EpisodePart::ids},
                        {EpisodePart::instances}};
  axis.look = [](View& view, const Scene&, int level, RandomStream stream) {
    constexpr std::array factors{1.02, 1.05, 1.1, 1.2};
    const double factor = factors.at(static_cast<std::size_t>(level - 1));
    view.zoom = stream.coin() ? factor : 1 / factor;
  };
  return axis;
}

}  // namespace lgabench::perturbations
