// The abstraction in the loss: copies of each step, in which what was not selected is noise, have the same label, and
// what the policy makes of them is not to differ. After Masked IRL (Hwang et al., ICRA 2026, arXiv 2511.14565): cloning
// in place of a learned reward; pixels in place of a state's dimensions.
#include <lgabench/plugin/plugin.hpp>

#include "pixel_policy.hpp"

using namespace lgabench;

class MaskedBc : public PixelPolicy {
 protected:
  int copies(const Json& options) const override { return options.at("copies").get<int>(); }
  void augment(Step& step, const Selection& selection, int, RandomStream& stream) const override {
    const Ids others = unselected(step.observation, selection);
    step.observation = repaint(std::move(step.observation), others, Noise{stream});
  }
};

LGABENCH_METHOD("masked_bc", "0.1",
                "Behaviour cloning on the picture, invariant to what a language model did not select", MaskedBc,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                "," LGABENCH_NO_MASK_OPTIONS "," LGABENCH_COPIES_OPTION R"(,
  "copies": {"default": 5, "min": 1, "max": 64, "help": "of each step, with noise on what was not selected", "source": "ours"},
  "copy_penalty": {"default": 1.0, "min": 0, "help": "how much a heat map counts that differs between a step and its copy; the network has the same labels alone",
                   "source": "arXiv 2511.14565: a penalty; its weight ours"}})")
