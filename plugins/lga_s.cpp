// LGA-S: as LGA, with the picture beside the goal mask, each through a tower of its own (paper, section 5, ablation).
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

class LgaS : public lgabench::CloningMethod {
 public:
  lgabench::Selection select(const lgabench::Command& command, const lgabench::FeatureSpace& space,
                             lgabench::Services& services) override {
    return lgabench::select_as_asked(command, space, services);
  }

 protected:
  lgabench::PolicyInputs inputs(const lgabench::Json&) const override {
    using Picture = lgabench::PolicyInputs::Picture;
    return {{Picture::mask, Picture::rgb}};
  }
};

LGABENCH_METHOD("lga_s", "0.1", "Behaviour cloning on a language model's goal mask and the picture", LgaS,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                "," LGABENCH_MASK_OPTIONS "}")
