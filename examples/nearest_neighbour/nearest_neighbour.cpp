// A method without training: the policy repeats the action of the demonstration whose goal mask is most similar.
// The example shows a Method and a Policy of your own, with the framework's goal mask. It links lgabench::core alone.
#include <algorithm>
#include <utility>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/plugin/plugin.hpp>

namespace {

using namespace lgabench;

struct Example {
  std::vector<std::uint8_t> mask;  // of the observation's size, 0 and 1
  Action action;
};

class NearestPolicy : public Policy {
 public:
  explicit NearestPolicy(std::vector<Example> examples) : examples_(std::move(examples)) {}

  // act() is a pure function: the same scene gives the same action, whatever was played before.
  Action act(const Observation& observation, const Instruction& instruction) override {
    const std::vector<std::uint8_t> mask = goal_mask(observation, instruction.selection);
    const auto distance = [&mask](const Example& example) {
      int differ = 0;
      for (std::size_t i = 0; i < mask.size(); ++i) differ += mask[i] != example.mask[i];
      return differ;
    };
    const auto nearer = [&](const Example& a, const Example& b) { return distance(a) < distance(b); };
    return std::min_element(examples_.begin(), examples_.end(), nearer)->action;
  }

 private:
  std::vector<Example> examples_;  // a copy: the demonstrations are freed once learn() has returned
};

class NearestNeighbour : public Method {
 public:
  // The default: training targets are drawn from what select() returns, no noisy rollouts.
  Needs needs(const Json&) const override { return {}; }

  // As in LGA, the Selection has the language model's answers and what they cost.
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    return select_features(command, space, services.lm);
  }

  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    if (demonstrations.empty()) throw MethodError("nearest_neighbour needs a demonstration");
    std::vector<Example> examples;
    for (const Demonstration& demonstration : demonstrations)
      for_each_step(demonstration, [&](const Step& step) {
        examples.push_back({goal_mask(step.observation, demonstration.instruction.selection), step.label});
      });
    services.log.epoch(1, 0, 0.0);  // one pass over the data, no optimiser step
    return std::make_unique<NearestPolicy>(std::move(examples));
  }
};

}  // namespace

LGABENCH_METHOD("nearest_neighbour", "0.1", "Does as the demonstration with the most similar goal mask",
                NearestNeighbour, "{}")
