// LGA, and of several objects that its Selection keeps the one that is most like what the command's demonstrations
// took: words and demonstrations together.
#include <map>

#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

#include "taken_features.hpp"

using namespace lgabench;

// Of the visible objects that may be taken the most demonstrated.
template <typename MayBe>
TakenLooks most_demonstrated(const Observation& observation, const TakenLooks& taken, const MayBe& may_be) {
  return likest(
      observation, [&taken](const Instance& one) { return taken.counted(one); }, may_be);
}

// Chooses within what it is told, wherever the command was demonstrated and the scene has some of it.
class ChoosesWithin : public Policy {
 public:
  ChoosesWithin(std::unique_ptr<Policy> policy, std::map<std::string, TakenFeatures> by_command, FeatureSpace space)
      : policy_(std::move(policy)), by_command_(std::move(by_command)), space_(std::move(space)) {}

  void reset() override { policy_->reset(); }
  Action act(const Observation& observation, const Instruction& instruction) override {
    const auto found = by_command_.find(instruction.utterance);
    if (found == by_command_.end()) return policy_->act(observation, instruction);
    Instruction chosen = instruction;
    Meaning& meant = chosen.selection.target;
    const std::vector<std::uint8_t> kept = grounded(meant, observation);
    const TakenLooks target = most_demonstrated(observation, found->second.taken,
                                                [&kept](const Instance& one) { return contains(kept, one.id); });
    if (!target.none()) {
      meant.sets = sets_of(target);  // its rule, which means the first of an order, means the same
      meant.turns.clear();           // they want it next
    }
    if (auto& second = chosen.selection.second) {
      const TakenLooks receiver = most_demonstrated(observation, found->second.received, [&](const Instance& one) {
        return second->contains(one.object_type, one.texture) && !target.has(one);
      });
      if (!receiver.none()) static_cast<FeatureSet&>(*second) = with(receiver, {}, space_);
    }
    return policy_->act(observation, chosen);
  }
  std::optional<bool> seen_in_training() const override { return policy_->seen_in_training(); }
  Shown shown() const override { return policy_->shown(); }

 private:
  std::unique_ptr<Policy> policy_;
  std::map<std::string, TakenFeatures> by_command_;  // by utterance
  FeatureSpace space_;
};

class LgaThenTaken : public CloningMethod {
 public:
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    space_ = space;
    return select_as_asked(command, space, services);
  }
  // Each demonstration shows a mask of what it took.
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    std::vector<Demonstration> shown = demonstrations;
    for (Demonstration& one : shown) {
      const TakenFeatures one_taken = taken_by({one}, services.actions);
      Selection& selection = one.instruction.selection;
      if (!one_taken.taken.none()) {
        selection.target.sets = sets_of(one_taken.taken);
        selection.target.turns.clear();
      }
      if (selection.second && !one_taken.received.none())
        static_cast<FeatureSet&>(*selection.second) = with(one_taken.received, {}, space_);
    }
    return std::make_unique<ChoosesWithin>(CloningMethod::learn(shown, services),
                                           taken_by_command(demonstrations, services.actions), space_);
  }

 private:
  FeatureSpace space_;
};

LGABENCH_METHOD("lga_then_taken", "0.1",
                "Behaviour cloning on a mask of the most demonstrated object that a language model's selection keeps",
                LgaThenTaken,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}")
