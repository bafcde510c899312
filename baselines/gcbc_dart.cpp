// GCBC-DART: goal-conditioned behaviour cloning on the picture and the command's embedding, on demonstrations with
// injected noise (Laskey et al. 2017; paper, section 5).
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/learning/noisy_copies.hpp>
#include <lgabench/plugin/plugin.hpp>

class GcbcDart : public lgabench::CloningMethod {
 public:
  lgabench::Needs needs(const lgabench::Json& options) const override {
    const bool recovery = options.at("dart") == "recovery";
    return {lgabench::Needs::Targets::truth, recovery ? 5 : 0, recovery ? .2 : 0};
  }

  lgabench::Selection select(const lgabench::Command&, const lgabench::FeatureSpace&, lgabench::Services&) override {
    return {};
  }

 protected:
  lgabench::PolicyInputs inputs(const lgabench::Json&) const override {
    return {{lgabench::PolicyInputs::Picture::rgb}, lgabench::PolicyInputs::Text::utterance};
  }

  lgabench::Samples training_rows(lgabench::Samples clean, const lgabench::Services& services) const override {
    const lgabench::Json& dart = services.options.at("dart");
    if (dart != "posthoc" && dart != "posthoc_ranges") return clean;
    constexpr int copies = 5;
    constexpr double scale = .05;
    return lgabench::with_noisy_copies(
        clean, copies, scale, services.seed,
        dart == "posthoc" ? lgabench::CopyNoise::deviations : lgabench::CopyNoise::ranges);
  }
};

LGABENCH_METHOD("gcbc_dart", "0.1",
                "Behaviour cloning on the picture and the command, with noise-injected demonstrations", GcbcDart,
                "{" LGABENCH_CLONING_OPTIONS "," LGABENCH_NO_MASK_OPTIONS R"(,
  "dart": {"default": "recovery", "values": ["recovery", "posthoc", "posthoc_ranges", "none"],
           "help": "recovery: five noisy rollouts a demonstration, and the oracle's action from where each leads; posthoc: five copies of its action and 36 x 72 picture with Gaussian noise of .05 of their standard deviations; posthoc_ranges: likewise, .05 on the picture and .05 of the range of each of the action's numbers, for actions whose numbers have different units",
           "source": "paper, section 5; docs/protocol.md, section 5; posthoc: released code"}})")
