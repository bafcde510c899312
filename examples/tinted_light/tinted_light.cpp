// A perturbation axis (docs/extending.md): the shipped axis light_colour as a plugin. It makes the same bytes.
#include <algorithm>
#include <array>
#include <cmath>

#include <lgabench/plugin/plugin.hpp>

namespace {

using namespace lgabench;

class TintedLight : public ObservationPerturbation {
 public:
  Observation perceive(Observation seen, int level, RandomStream stream) override {
    constexpr std::array deviation{.1, .2, .3, .45};
    std::array<double, 3> factors;
    double largest = 0;
    for (double& way : factors) {
      way = stream.uniform(-1, 1);
      largest = std::max(largest, std::abs(way));
    }
    for (double& way : factors) way = 1 + deviation.at(static_cast<std::size_t>(level - 1)) * way / largest;
    for (std::size_t i = 0; i < seen.rgb.size(); ++i)
      seen.rgb[i] = static_cast<std::uint8_t>(std::lround(std::clamp(seen.rgb[i] * factors[i % 3], 0., 255.)));
    return seen;
  }
};

}  // namespace

LGABENCH_PERTURBATION("tinted_light", "0.1", "Light of another colour", TintedLight, R"({
  "levels": ["10 %", "20 %", "30 %", "45 %"],
  "changes": ["rgb"]})")
