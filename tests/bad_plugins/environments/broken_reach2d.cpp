// examples/reach2d, whose episodes break the interface in the way that LGABENCH_TEST_BREAKS names.
#include <cstdlib>
#include <limits>

#include <lgabench/plugin/simple_environment.hpp>

#pragma push_macro("LGABENCH_ENVIRONMENT")
#undef LGABENCH_ENVIRONMENT
#define LGABENCH_ENVIRONMENT(...)
#include "../../../examples/reach2d/reach2d.cpp"
#pragma pop_macro("LGABENCH_ENVIRONMENT")

namespace {

bool breaks(const std::string& how) {
  const char* const asked = std::getenv("LGABENCH_TEST_BREAKS");
  return asked && how == asked;
}

class Broken final : public Plane {
 public:
  using Plane::Plane;

  Observation reset(const Scene& scene) override {
    static int resets = 0;
    ++resets;
    Observation seen = Plane::reset(scene);
    if (breaks("length") && !seen.state.empty()) seen.state.pop_back();
    if (breaks("remembers") && !seen.state.empty()) seen.state.back() *= 1 - 1e-9 * resets;
    return seen;
  }

  StepResult step(const Action& action) override {
    StepResult result = Plane::step(action);
    std::vector<double>& state = result.observation.state;
    if (breaks("nan") && !state.empty()) state.front() = std::numeric_limits<double>::quiet_NaN();
    if (breaks("wins_and_goes_on") && result.is_success) result.terminated = false;
    if (breaks("wins_and_fails") && result.is_success) result.failure = not_reached;
    if (breaks("ends_without_a_word")) result.terminated = true;
    if (breaks("fails_and_goes_on")) result.failure = not_reached;
    if (breaks("word") && result.terminated && !result.is_success) result.failure = "lost_way";
    if (breaks("never_ends")) {
      result.terminated = result.is_success = false;
      result.failure = failure::goes_on;
    }
    return result;
  }

  Action expert_action() const override {
    if (breaks("oracle_stops")) return {};
    if (breaks("oracle_waits")) return {0, 0};
    is_oracle_ = true;
    Action action = Plane::expert_action();
    is_oracle_ = false;
    return action;
  }

  Action expert_action_for(std::uint8_t id) const override {
    if (breaks("one_object") && !is_oracle_) throw InputError("only what is meant is taken");
    return Plane::expert_action_for(id);
  }

 private:
  mutable bool is_oracle_ = false;  // it asks for the target's action
};

class BrokenReach2d final : public Reach2d {
 protected:
  std::unique_ptr<Environment> make(const std::string& task) const override {
    return std::make_unique<Broken>(action_space(), task != blind);
  }
};

}  // namespace

LGABENCH_ENVIRONMENT("reach2d", "0.1", "A point that is steered to a disc, against the interface", BrokenReach2d)
