// The abstraction in the picture at test time: a policy that sees pixels, from which what was not selected is painted
// out. After BYOVLA (arXiv 2410.01971; `gated` erases what the action is sensitive to) and CGVD (2603.10340): the usual
// background of the demonstrations in place of an inpainting network.
#include <lgabench/plugin/plugin.hpp>

#include <cmath>

#include "pixel_policy.hpp"

using namespace lgabench;

namespace {

// Acts on a picture without what another policy's action depends on, though it was not selected.
class Gated : public Policy {
 public:
  Gated(std::unique_ptr<Policy> policy, Background background, double threshold, std::uint64_t seed,
        ActionSpace actions)
      : policy_(std::move(policy)),
        background_(std::move(background)),
        threshold_(threshold),
        seed_(seed),
        actions_(std::move(actions)) {}

  void reset() override { policy_->reset(); }
  Action act(const Observation& seen, const Instruction& instruction) override {
    const Action usual = policy_->act(seen, instruction);
    Ids erased;
    for (const std::uint8_t id : unselected(seen, instruction.selection))
      if (sensitivity(seen, instruction, id, usual) > threshold_) erased.push_back(id);
    return policy_->act(repaint(seen, erased, background_), instruction);
  }
  std::optional<bool> seen_in_training() const override { return policy_->seen_in_training(); }
  Shown shown() const override { return policy_->shown(); }

 private:
  // How far noise on the instance moves the first place, at most, in its unit.
  double sensitivity(const Observation& seen, const Instruction& instruction, std::uint8_t id, const Action& usual) {
    constexpr int samples = 5;
    const auto [down, across] = actions_.places.front();
    RandomStream stream("erase/gated/" + std::to_string(seed_) + "/" + std::to_string(id));
    double most = 0;
    for (int i = 0; i < samples; ++i) {
      const Action action = policy_->act(repaint(seen, {id}, Noise{stream}), instruction);
      most = std::max(most, std::hypot(action[down] - usual[down], action[across] - usual[across]));
    }
    return most;
  }

  std::unique_ptr<Policy> policy_;
  Background background_;
  double threshold_;
  std::uint64_t seed_;
  ActionSpace actions_;
};

}  // namespace

class Erase : public PixelPolicy {
 public:
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    background_ = usual_background(demonstrations);
    std::unique_ptr<Policy> policy = CloningMethod::learn(demonstrations, services);
    if (services.options.at("when") != "gated") return policy;
    return std::make_unique<Gated>(std::move(policy), background_, services.options.at("threshold").get<double>(),
                                   services.seed, services.actions);
  }

 protected:
  PolicyInputs inputs(const Json& options) const override {
    PolicyInputs inputs = PixelPolicy::inputs(options);
    const std::string when = options.at("when");
    if (when == "gated") return inputs;
    inputs.of_demonstrations = true;
    inputs.prepare = [when, background = background_](const Observation& seen, const Selection& selection,
                                                      Phase phase) {
      const bool erases = when == "both" || (when == "train") == (phase == Phase::training);
      return erases ? repaint(seen, unselected(seen, selection), background) : seen;
    };
    return inputs;
  }

 private:
  Background background_;
};

LGABENCH_METHOD("erase", "0.1", "Behaviour cloning on the picture, from which what was not selected is painted out",
                Erase,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                "," LGABENCH_NO_MASK_OPTIONS R"(,
  "when": {"default": "test", "values": ["train", "test", "both", "gated"],
           "help": "which pictures are painted over; gated: at test, what the action is sensitive to", "source": "arXiv 2603.10340; gated: 2410.01971"},
  "threshold": {"default": 0.01, "min": 0,
                "help": "gated: how far noise on an object moves the action's first place, in its unit, for it to be erased", "source": "ours"}})")
