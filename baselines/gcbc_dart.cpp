// GCBC-DART: goal-conditioned behaviour cloning on the picture and the command's embedding, on demonstrations with
// injected noise (Laskey et al. 2017; paper, section 5).
#include <lgabench/learning/cloning_method.hpp>
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
};

LGABENCH_METHOD("gcbc_dart", "0.1",
                "Behaviour cloning on the picture and the command, with noise-injected demonstrations", GcbcDart,
                "{" LGABENCH_CLONING_OPTIONS "," LGABENCH_NO_MASK_OPTIONS R"(,
  "dart": {"default": "recovery", "values": ["recovery", "none"],
           "help": "recovery: five noisy rollouts a demonstration, and the oracle's action from where each leads",
           "source": "paper, section 5; PROTOCOL, section 5"}})")
