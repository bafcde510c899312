// No language: a mask of what looks most like what the command's demonstrations took; for a command that nobody
// demonstrated, like what any of them took. Reads the labels that LGA reads, so that what LGA has beyond it is not the
// labels. The reference row most_demonstrated, as a mask under a policy.
#include <map>

#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

#include "taken_features.hpp"

namespace {

using namespace lgabench;

// Of the visible objects beside those given the likest, all where several are alike.
Counts likest(const Observation& observation, const Counts& counts, const Counts& beside) {
  Counts best;
  double most = 0;
  for (const Instance& one : observation.instances) {
    const double score = counts.score(one);
    if (one.pixels == 0 || is_place(one.object_type) || beside.has(one) || score < most) continue;
    if (score > most) best.objects.clear();
    most = score;
    best.objects.emplace_back(one.object_type, one.texture);
  }
  return best;
}

// All types and all textures of what was taken, and of what it was brought to where a second set is asked for.
void keep(Selection& selection, const TakenFeatures& features, const FeatureSpace& space) {
  selection.target = with(features.taken, {}, space);
  if (selection.second) static_cast<FeatureSet&>(*selection.second) = with(features.received, {}, space);
}

// Acts on a mask of the likest object in view, wherever it is told what revise() selected.
class ActsOnTheLikest : public Policy {
 public:
  ActsOnTheLikest(std::unique_ptr<Policy> policy, std::map<std::string, TakenFeatures> by_command, TakenFeatures all,
                  std::map<std::string, Json> revised, FeatureSpace space)
      : policy_(std::move(policy)),
        by_command_(std::move(by_command)),
        all_(std::move(all)),
        revised_(std::move(revised)),
        space_(std::move(space)) {}

  void reset() override { policy_->reset(); }
  Action act(const Observation& observation, const Instruction& instruction) override {
    const auto revised = revised_.find(instruction.utterance);
    if (revised == revised_.end() || revised->second != distribution_json(instruction.selection))
      return policy_->act(observation, instruction);
    const auto own = by_command_.find(instruction.utterance);
    const TakenFeatures& features = own == by_command_.end() ? all_ : own->second;
    Instruction likest_of_all = instruction;
    const Counts target = likest(observation, features.taken, {});
    Meaning& meaning = likest_of_all.selection.target = Meaning();
    if (!target.none()) meaning.sets.clear();
    for (const auto& [type, texture] : target.objects) meaning.sets.push_back({{type}, {texture}});
    if (auto& second = likest_of_all.selection.second)
      static_cast<FeatureSet&>(*second) = with(likest(observation, features.received, target), {}, space_);
    return policy_->act(observation, likest_of_all);
  }
  std::optional<bool> seen_in_training() const override { return policy_->seen_in_training(); }
  Shown shown() const override { return policy_->shown(); }

 private:
  std::unique_ptr<Policy> policy_;
  std::map<std::string, TakenFeatures> by_command_;
  TakenFeatures all_;
  std::map<std::string, Json> revised_;  // by utterance
  FeatureSpace space_;
};

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
  // All that was taken: what is scored as its Selection.
  Selection revise(const Command& command, const Selection& selected, const std::vector<Demonstration>& demonstrations,
                   Services& services) override {
    TakenFeatures features = taken_for(command.utterance, demonstrations, services.actions);
    if (features.taken.none()) features = taken_by(demonstrations, services.actions);
    Selection revised = selected;
    keep(revised, features, space_);
    revised_[command.utterance] = distribution_json(revised);
    return revised;
  }
  // Each demonstration shows a mask of what it took.
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    std::map<std::string, TakenFeatures> by_command;
    std::vector<Demonstration> shown = demonstrations;
    for (Demonstration& one : shown) {
      TakenFeatures own;
      own.add(one, services.actions);
      by_command[one.instruction.utterance].add(one, services.actions);
      keep(one.instruction.selection, own, space_);
    }
    return std::make_unique<ActsOnTheLikest>(CloningMethod::learn(shown, services), std::move(by_command),
                                             taken_by(demonstrations, services.actions), revised_, space_);
  }

 private:
  FeatureSpace space_;
  std::map<std::string, Json> revised_;
};

}  // namespace

LGABENCH_METHOD("taken_features", "0.1",
                "Behaviour cloning on a mask of what looks most like what was taken, without language", OfTaken,
                "{" LGABENCH_CLONING_OPTIONS "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}")
