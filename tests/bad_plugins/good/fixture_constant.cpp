// The smallest whole method: acts as in one of its demonstrations, whatever it sees.
#include <algorithm>

#include "../fixture.hpp"

namespace {

using namespace lgabench;

class ConstantPolicy : public Policy {
 public:
  explicit ConstantPolicy(const Action& action) : action_(action) {}
  Action act(const Observation&, const Instruction&) override { return action_; }

 private:
  Action action_;
};

class Constant : public fixture::FixtureMethod<fixture::StayPolicy> {
 public:
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    if (demonstrations.empty()) throw MethodError("needs a demonstration");
    const auto wanted = services.options.at("demonstration").get<std::size_t>();
    const auto& steps = demonstrations[std::min(wanted, demonstrations.size() - 1)].steps;
    services.log.epoch(1, static_cast<long long>(demonstrations.size()), 0.0);
    return std::make_unique<ConstantPolicy>(steps.at(0).label);
  }
};

}  // namespace

LGABENCH_METHOD("fixture_constant", "0.1", "acts as in one of its demonstrations", Constant, R"({
  "demonstration": {"default": 0, "min": 0, "help": "which one it repeats", "source": "test fixture"},
  "scale": {"default": 1.0, "help": "unused, a fractional option", "source": "test fixture"},
  "mode": {"default": "plain", "help": "unused, one of a few", "source": "test fixture", "values": ["plain", "other"]},
  "verbose": {"default": false, "help": "unused, a boolean", "source": "test fixture"}
})")
