// The abstraction in the data: copies of each step with random textures on the table and on what was not selected.
// After GreenAug (arXiv 2407.07868, whose random textures did better than generated pictures) and ROSIE (2302.11550):
// procedural textures alone, and ids in place of a green screen or a segmenter.
#include <lgabench/plugin/plugin.hpp>

#include "pixel_policy.hpp"

using namespace lgabench;

class TextureAug : public PixelPolicy {
 protected:
  int copies(const Json& options) const override { return options.at("copies").get<int>(); }
  void augment(Step& step, const Selection& selection, int, RandomStream& stream) const override {
    Ids others = unselected(step.observation, selection);
    others.push_back(0);
    step.observation = repaint(std::move(step.observation), others, RandomTextures{stream});
  }
};

LGABENCH_METHOD("texture_aug", "0.1", "Behaviour cloning on the picture, with random textures on what was not selected",
                TextureAug,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                "," LGABENCH_NO_MASK_OPTIONS "," LGABENCH_COPIES_OPTION R"(,
  "copies": {"default": 5, "min": 1, "max": 64, "help": "of each step, with random textures", "source": "ours"}})")
