// LGA: the policy sees only the goal mask of what a language model selected (paper, section 3).
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

class Lga : public lgabench::CloningMethod {
 public:
  lgabench::Selection select(const lgabench::Command& command, const lgabench::FeatureSpace& space,
                             lgabench::Services& services) override {
    return lgabench::select_as_asked(command, space, services);
  }
};

LGABENCH_METHOD("lga", "0.1", "Behaviour cloning on a goal mask that a language model selected", Lga,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}")
