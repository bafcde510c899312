// LGA-L: behaviour cloning on the picture, told the Selection in words in place of the command; no mask (paper, section
// 5, ablation).
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

class LgaL : public lgabench::CloningMethod {
 public:
  lgabench::Selection select(const lgabench::Command& command, const lgabench::FeatureSpace& space,
                             lgabench::Services& services) override {
    space_ = space;
    return lgabench::select_as_asked(command, space, services);
  }

 protected:
  lgabench::PolicyInputs inputs(const lgabench::Json& options) const override {
    lgabench::PolicyInputs inputs;
    if (options.at("image") == "rgb") inputs.pictures = {lgabench::PolicyInputs::Picture::rgb};
    inputs.text = lgabench::PolicyInputs::Text::selection;
    inputs.space = space_;
    return inputs;
  }

 private:
  lgabench::FeatureSpace space_;
};

LGABENCH_METHOD("lga_l", "0.1", "Behaviour cloning on the picture and a language model's Selection in words", LgaL,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                "," LGABENCH_NO_MASK_OPTIONS R"(,
  "image": {"default": "rgb", "values": ["rgb", "none"], "help": "what the policy sees beside the words",
            "needs": {"none": {"policy": ["regression"]}},
            "source": "rgb: the authors' older notebook, where these bars are named GCBC (lang abs.); none: paper, section 5, read to the letter"}})")
