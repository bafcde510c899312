// What a Selection does to the data apart from what it does to the input: every pair of training scenes and picture
// (docs/suites.md). No text input but with object_mask_and_words. With all defaults it is LGA. With
// policy=centroid, what an abstraction is worth to a policy that need not learn where pixels are.
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

class Factorial : public lgabench::CloningMethod {
 public:
  lgabench::Needs needs(const lgabench::Json& options) const override {
    using Targets = lgabench::Needs::Targets;
    return {options.at("scenes") == "truth" ? Targets::truth : Targets::selected};
  }

  lgabench::Selection select(const lgabench::Command& command, const lgabench::FeatureSpace& space,
                             lgabench::Services& services) override {
    true_masks_[command.utterance] = services.truth(command);
    return lgabench::select_as_asked(command, space, services);
  }

 protected:
  lgabench::PolicyInputs inputs(const lgabench::Json& options) const override {
    using Picture = lgabench::PolicyInputs::Picture;
    if (options.at("input") == "rgb") return {{Picture::rgb}};
    if (options.at("input") == "object_mask" || options.at("input") == "object_mask_and_words") {
      lgabench::PolicyInputs inputs{{Picture::segmentation}};
      inputs.left_out = "pallet";  // the place to bring things to: never a target
      if (options.at("input") == "object_mask_and_words") inputs.text = lgabench::PolicyInputs::Text::utterance;
      return inputs;
    }
    if (options.at("input") == "true_mask")
      return {{Picture::mask}, lgabench::PolicyInputs::Text::none, {}, true_masks_};
    return {{Picture::mask}};
  }

 private:
  std::map<std::string, lgabench::Selection> true_masks_;  // by utterance
};

LGABENCH_METHOD_ASKING("truth", "factorial", "0.1",
                       "LGA with the training scenes or the policy's input replaced, to tell their effects apart",
                       Factorial,
                       "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS R"(,
  "scenes": {"default": "selected", "values": ["selected", "truth"],
             "help": "training targets drawn from the language model's Selection, or from the true distribution",
             "source": "docs/suites.md"},
  "input": {"default": "mask", "values": ["mask", "true_mask", "object_mask", "object_mask_and_words", "rgb"],
            "help": "the policy sees the mask of the Selection, of the true distribution, of any object but the pallet (and_words: and the command), or the picture",
            "source": "docs/suites.md; object_mask, object_mask_and_words: ours"},
)" LGABENCH_MASK_OPTIONS_WITH(R"(, "needs": {"first": {"input": ["mask", "true_mask"]}})",
                              R"(, "needs": {"signed": {"input": ["mask", "true_mask"], "policy": ["regression"]}})",
                              R"(, "needs": {"centroid": {"input": ["mask", "true_mask", "object_mask"]}})") "}")
