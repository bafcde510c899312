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

double distance(const ActionVector& a, const ActionVector& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (double{a[i]} - b[i]) * (double{a[i]} - b[i]);
  return std::sqrt(sum);
}

}  // namespace

std::unique_ptr<Policy> ConstantAction::learn(const std::vector<Demonstration>& demonstrations, Services&) {
  std::vector<ActionVector> labels;
  for (const Demonstration& demonstration : demonstrations)
    for (const Step& step : demonstration.steps) labels.push_back(to_vector(step.label));
  double least = std::numeric_limits<double>::infinity();
  const ActionVector* medoid = nullptr;
  for (const ActionVector& candidate : labels) {
    double sum = 0;
    for (const ActionVector& label : labels) sum += distance(candidate, label);
    if (sum < least) {
      least = sum;
      medoid = &candidate;
    }
  }
  if (!medoid) throw MethodError("a constant action needs at least one demonstration");
  return std::make_unique<OneAction>(from_vector(*medoid));
}

}  // namespace lgabench
