// A method that asks everyone everything and looks at all that it is given, for the fuzz target host_frames.
#include <lgabench/plugin/plugin.hpp>

#include <numeric>

using namespace lgabench;

long long sum_of(const Observation& observation) {
  const auto sum = [](const auto& all) { return std::accumulate(all.begin(), all.end(), 0LL); };
  long long total = sum(observation.rgb) + sum(observation.ids);
  for (const Instance& i : observation.instances) total += i.id + static_cast<long long>(i.object_type.size());
  return total;
}

class Looking : public Policy {
 public:
  explicit Looking(long long seen) : seen_(seen) {}
  void reset() override { seen_ = 0; }
  Action act(const Observation& observation, const Instruction& instruction) override {
    seen_ += sum_of(observation) + static_cast<long long>(instruction.utterance.size());
    Action action(12);
    action[0] = static_cast<double>(seen_);
    return action;
  }
  std::optional<bool> seen_in_training() const override { return seen_ > 0; }

 private:
  long long seen_;
};

class Curious : public Method {
 public:
  Needs needs(const Json&) const override { return {}; }
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    std::vector<Question> questions;
    for (const std::string& type : space.object_types) questions.push_back({{}, {}, type});
    const std::vector<bool> answers = services.lm.answer(command, space, questions);
    Selection selection = services.human.edit(command, services.human.specify(command));
    selection.target.product().textures = services.truth(command).target.product().textures;
    for (std::size_t i = 0; i < std::min(answers.size(), questions.size()); ++i)
      if (answers[i]) selection.target.product().object_types.push_back(questions[i].candidate);
    selection.source = services.lm.model() + services.lm.asked_as(command);
    selection.cost = services.lm.cost();
    return selection;
  }
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    long long seen = 0;
    for (const Demonstration& demonstration : demonstrations)
      for (const Step& step : demonstration.steps) seen += sum_of(step.observation);
    services.log.epoch(1, seen, 0.5);
    return std::make_unique<Looking>(seen);
  }
};

LGABENCH_METHOD("curious", "1", "Asks everyone everything", Curious, "{}")
