// LGA in colour: the policy sees the picture, black where the goal mask is 0. Shows `prepare`, which computes the
// policy's input; network and training are lgabench's.
#include <algorithm>

#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

namespace {

using namespace lgabench;

// The same in training and tests; refers to no method, which is destroyed before the policy acts.
Observation masked(const Observation& observation, const Selection& selection, Phase) {
  Observation shown = observation;
  const std::vector<std::uint8_t> mask = goal_mask(observation, selection);
  for (std::size_t pixel = 0; pixel < mask.size(); ++pixel)
    if (mask[pixel] == 0) std::fill_n(shown.rgb.begin() + static_cast<std::ptrdiff_t>(3 * pixel), 3, std::uint8_t{0});
  return shown;
}

class MaskedRgb : public CloningMethod {
 public:
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    return select_features(command, space, services.lm);
  }

 protected:
  PolicyInputs inputs(const Json&) const override {
    PolicyInputs inputs{{PolicyInputs::Picture::rgb}};
    inputs.prepare = masked;
    return inputs;
  }
};

}  // namespace

LGABENCH_METHOD("masked_rgb", "0.1", "Behaviour cloning on the colours of what a language model selected", MaskedRgb,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_CLONING_OPTIONS "}")
