#include <lgabench/cell/constant_action.hpp>

#include <cmath>
#include <limits>

namespace lgabench {
namespace {

class OneAction : public Policy {
 public:
  explicit OneAction(const Action& action) : action_(action) {}
  Action act(const Observation&, const Instruction&) override { return action_; }

 private:
  Action action_;
};

double distance(const Action& a, const Action& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

}  // namespace

std::unique_ptr<Policy> ConstantAction::learn(const std::vector<Demonstration>& demonstrations, Services&) {
  std::vector<Action> labels;
  for (const Demonstration& demonstration : demonstrations)
    for_each_step(demonstration, [&](const Step& step) {
      if (!step.label.empty()) labels.push_back(step.label);
    });
  double least = std::numeric_limits<double>::infinity();
  const Action* medoid = nullptr;
  for (const Action& candidate : labels) {
    double sum = 0;
    for (const Action& label : labels) sum += distance(candidate, label);
    if (sum < least) {
      least = sum;
      medoid = &candidate;
    }
  }
  if (!medoid) throw MethodError("a constant action needs at least one demonstration");
  return std::make_unique<OneAction>(*medoid);
}

}  // namespace lgabench
