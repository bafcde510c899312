// GCBC-SEG: goal-conditioned behaviour cloning on the picture, a segmentation without language, and the command's
// embedding (paper, section 5).
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

class GcbcSeg : public lgabench::CloningMethod {
 public:
  lgabench::Needs needs(const lgabench::Json&) const override { return {lgabench::Needs::Targets::truth}; }

  lgabench::Selection select(const lgabench::Command&, const lgabench::FeatureSpace&, lgabench::Services&) override {
    return {};
  }

 protected:
  lgabench::PolicyInputs inputs(const lgabench::Json&) const override {
    using Inputs = lgabench::PolicyInputs;
    return {{Inputs::Picture::rgb, Inputs::Picture::segmentation}, Inputs::Text::utterance};
  }
};

LGABENCH_METHOD("gcbc_seg", "0.1", "Behaviour cloning on the picture, a mask of all objects, and the command", GcbcSeg,
                "{" LGABENCH_CLONING_OPTIONS "," LGABENCH_NO_MASK_OPTIONS "}")
