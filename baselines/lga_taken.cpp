// LGA, and the features of what the command's demonstrations took: an answer that missed one is mended by what is
// shown.
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

#include "taken_features.hpp"

using namespace lgabench;

class LgaTaken : public CloningMethod {
 public:
  Needs needs(const Json& options) const override {
    Needs needs = CloningMethod::needs(options);
    needs.revise = true;
    return needs;
  }
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    space_ = space;
    return select_as_asked(command, space, services);
  }
  Selection revise(const Command& command, const Selection& selected, const std::vector<Demonstration>& demonstrations,
                   Services& services) override {
    const auto [taken, received] = taken_for(command.utterance, demonstrations, services.actions);
    Selection revised = selected;
    Meaning& target = revised.target;
    if (target.is_product()) {
      target = with(taken, target.product(), space_);
    } else if (target.turns.empty()) {  // what is shown does not say in which turn it was taken
      for (const auto& [type, texture] : taken.objects)
        if (!target.belongs(type, texture)) target.sets.push_back({{type}, {texture}});
    }
    if (revised.second) static_cast<FeatureSet&>(*revised.second) = with(received, *revised.second, space_);
    return revised;
  }

 private:
  FeatureSpace space_;
};

LGABENCH_METHOD("lga_taken", "0.1",
                "Behaviour cloning on a goal mask of what a language model selected and of what was taken", LgaTaken,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}")
