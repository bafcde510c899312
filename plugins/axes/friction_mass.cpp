// Slippery and heavy bodies, which nobody sees: a control of the other axes, since suction holds them all the same.
#include <lgabench/core/perturbations.hpp>

namespace lgabench::perturbations {
namespace {

constexpr std::array friction{.8, .5, .25, .1}, mass{1.5, 2., 4., 8.};

}  // namespace

PerturbationAxis friction_mass() {
  PerturbationAxis axis{
      "friction_mass", {"friction x .8, mass x 1.5", "x .5, x 2", "x .25, x 4", "x .1, x 8"}, {EpisodePart::physics}};
  axis.change = [](Scene scene, const Scenario&, int level, RandomStream) {
    scene.friction = friction.at(static_cast<std::size_t>(level - 1));
    scene.mass = mass.at(static_cast<std::size_t>(level - 1));
    return scene;
  };
  axis.lacks = lacks_engine;
  axis.bodies = [](int level) {
    const auto at = static_cast<std::size_t>(level - 1);
    return BodyVariants{{1}, friction.at(at), mass.at(at)};
  };
  return axis;
}

}  // namespace lgabench::perturbations
