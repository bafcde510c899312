// A perturbation axis (docs/extending.md): colours fade to a grey, as fog does.
#include <lgabench/plugin/plugin.hpp>

namespace {

using namespace lgabench;

class Fog : public ObservationPerturbation {
 public:
  Observation perceive(Observation seen, int level, RandomStream stream) override {
    const double share = .15 * level, grey = stream.uniform(120, 220);  // the same grey at every level
    for (std::uint8_t& value : seen.rgb) value = static_cast<std::uint8_t>((1 - share) * value + share * grey + .5);
    return seen;
  }
};

}  // namespace

LGABENCH_PERTURBATION("fog", "0.1", "Fog: colours fade to a grey", Fog, R"({
  "levels": ["15 % grey", "30 %", "45 %", "60 %"],
  "changes": ["rgb"]})")
