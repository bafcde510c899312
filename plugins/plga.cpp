// PLGA: as LGA, with what the person leaves unsaid, as far as what they take shows it (after Peng et al., HRI 2024).
#include <lgabench/abstraction/preference.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

class Plga : public lgabench::CloningMethod {
 public:
  lgabench::Needs needs(const lgabench::Json& options) const override {
    lgabench::Needs needs = CloningMethod::needs(options);
    needs.revise = true;
    return needs;
  }
  lgabench::Selection select(const lgabench::Command& command, const lgabench::FeatureSpace& space,
                             lgabench::Services& services) override {
    space_ = space;
    return lgabench::select_as_asked(command, space, services);
  }
  lgabench::Selection revise(const lgabench::Command& command, const lgabench::Selection& selected,
                             const std::vector<lgabench::Demonstration>& demonstrations,
                             lgabench::Services& services) override {
    return lgabench::preferred(command, selected, space_, demonstrations, services, lgabench::AskPerson::no);
  }

 private:
  lgabench::FeatureSpace space_;
};

LGABENCH_METHOD("plga", "0.1", "Behaviour cloning on a goal mask of what a person is likely to prefer", Plga,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}")
