// No language: what matters is what the command's demonstrations took; for a command that nobody demonstrated, what any
// of them took. Reads the labels that LGA reads, so that what LGA has beyond it is not the labels.
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

#include "taken_features.hpp"

using namespace lgabench;

class OfTaken : public CloningMethod {
 public:
  Needs needs(const Json&) const override {
    Needs needs{Needs::Targets::truth};
    needs.revise = true;
    return needs;
  }
  // Before anything is shown, everything could be meant.
  Selection select(const Command& command, const FeatureSpace& space, Services&) override {
    space_ = space;
    Selection selection;
    selection.target = {space.object_types, space.textures};
    if (command.second) selection.second = {selection.target.product(), command.second->id};
    return selection;
  }
  Selection revise(const Command& command, const Selection& selected, const std::vector<Demonstration>& demonstrations,
                   Services& services) override {
    TakenFeatures features = taken_for(command, demonstrations, services.actions);
    if (features.taken.empty())
      for (const Demonstration& one : demonstrations) features.add(one, services.actions);
    Selection revised = selected;
    revised.target = with(features.taken, {}, space_);
    if (revised.second) static_cast<FeatureSet&>(*revised.second) = with(features.received, {}, space_);
    return revised;
  }

 private:
  FeatureSpace space_;
};

LGABENCH_METHOD("taken_features", "0.1",
                "Behaviour cloning on a goal mask of types and textures that were taken, without language", OfTaken,
                "{" LGABENCH_CLONING_OPTIONS "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}")
