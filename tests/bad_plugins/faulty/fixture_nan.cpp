#include <limits>

#include "../fixture.hpp"

namespace {

class P : public fixture::StayPolicy {
 public:
  lgabench::Action act(const lgabench::Observation& observation, const lgabench::Instruction& instruction) override {
    lgabench::Action action = StayPolicy::act(observation, instruction);
    action[7] = std::numeric_limits<double>::quiet_NaN();
    return action;
  }
};

}  // namespace

LGABENCH_METHOD("fixture_nan", "0.1", "returns an action that is not a number", fixture::FixtureMethod<P>, "{}")
