// A mask of what looks most like what the command's demonstrations took; for a command that nobody demonstrated, like
// what any of them took. Reads the labels that LGA reads, and not the command, so that what LGA has beyond it is not
// the labels.
#pragma once
#include <functional>
#include <map>

#include <lgabench/learning/cloning_method.hpp>

#include "taken_features.hpp"

namespace lgabench {

// How much an object is like what was taken.
using Score = std::function<double(const Instance& one, const TakenLooks& taken)>;

// All types and all textures of what was taken, and of what it was brought to where a second set is asked for.
inline void keep(Selection& selection, const TakenFeatures& features, const FeatureSpace& space) {
  selection.target = with(features.taken, {}, space);
  if (selection.second) static_cast<FeatureSet&>(*selection.second) = with(features.received, {}, space);
}

// Acts on a mask of the likest object in view, wherever it is told what revise() selected.
class ActsOnTheLikest : public Policy {
 public:
  ActsOnTheLikest(std::unique_ptr<Policy> policy, std::map<std::string, TakenFeatures> by_command, TakenFeatures all,
                  std::map<std::string, Json> revised, FeatureSpace space, Score score)
      : policy_(std::move(policy)),
        by_command_(std::move(by_command)),
        all_(std::move(all)),
        revised_(std::move(revised)),
        space_(std::move(space)),
        score_(std::move(score)) {}

  void reset() override { policy_->reset(); }
  Action act(const Observation& observation, const Instruction& instruction) override {
    const auto revised = revised_.find(instruction.utterance);
    if (revised == revised_.end() || revised->second != distribution_json(instruction.selection))
      return policy_->act(observation, instruction);
    const auto found = by_command_.find(instruction.utterance);
    const TakenFeatures& features = found == by_command_.end() ? all_ : found->second;
    Instruction likest_of_all = instruction;
    const TakenLooks target = likest_beside({}, observation, features.taken);
    Meaning& meaning = likest_of_all.selection.target = Meaning();
    if (!target.none()) meaning.sets = sets_of(target);
    if (auto& second = likest_of_all.selection.second)
      static_cast<FeatureSet&>(*second) = with(likest_beside(target, observation, features.received), {}, space_);
    return policy_->act(observation, likest_of_all);
  }
  std::optional<bool> seen_in_training() const override { return policy_->seen_in_training(); }
  Shown shown() const override { return policy_->shown(); }

 private:
  TakenLooks likest_beside(const TakenLooks& others, const Observation& observation, const TakenLooks& taken) const {
    return likest(
        observation, [&](const Instance& one) { return score_(one, taken); },
        [&](const Instance& one) { return !others.has(one); });
  }

  std::unique_ptr<Policy> policy_;
  std::map<std::string, TakenFeatures> by_command_;
  TakenFeatures all_;
  std::map<std::string, Json> revised_;  // by utterance
  FeatureSpace space_;
  Score score_;
};

class OfTaken : public CloningMethod {
 public:
  explicit OfTaken(Score score) : score_(std::move(score)) {}
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
    std::vector<Demonstration> shown = demonstrations;
    for (Demonstration& one : shown) keep(one.instruction.selection, taken_by({one}, services.actions), space_);
    return std::make_unique<ActsOnTheLikest>(CloningMethod::learn(shown, services),
                                             taken_by_command(demonstrations, services.actions),
                                             taken_by(demonstrations, services.actions), revised_, space_, score_);
  }

 private:
  Score score_;
  FeatureSpace space_;
  std::map<std::string, Json> revised_;
};

}  // namespace lgabench
