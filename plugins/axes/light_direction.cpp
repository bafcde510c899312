// Light from elsewhere: shadows fall another way, and surfaces that face it are brighter. The table is as bright as
// ever.
#include <lgabench/core/perturbations.hpp>

#include <cmath>

namespace lgabench::perturbations {
namespace {

// The usual light, turned by the angle; `way`: 0 along the horizon, a quarter turn towards the vertical.
Vec3 turned(double angle, double way) {
  const Vec3& light = usual_light;
  const double level = std::hypot(light.x, light.y);
  const Vec3 across{-light.y / level, light.x / level, 0},
      up{-light.z * light.x / level, -light.z * light.y / level, level};  // both at right angles to it
  return std::cos(angle) * light + std::sin(angle) * (std::cos(way) * across + std::sin(way) * up);
}

}  // namespace

PerturbationAxis light_direction() {
  PerturbationAxis axis{
      "light_direction", {"15 degrees", "30 degrees", "45 degrees", "60 degrees"}, {EpisodePart::rgb}};
  axis.look = [](View& view, const Scene&, int level, RandomStream stream) {
    constexpr std::array angles{pi / 12, pi / 6, pi / 4, pi / 3};
    constexpr double least = 25 * pi / 180;  // above the table, at the last level and so at all
    double way = 0;
    do way = stream.uniform(0, 2 * pi);
    while (turned(angles.back(), way).z < std::sin(least));
    view.light = turned(angles.at(static_cast<std::size_t>(level - 1)), way);
  };
  return axis;
}

}  // namespace lgabench::perturbations
