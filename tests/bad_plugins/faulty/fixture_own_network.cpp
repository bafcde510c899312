// Names a network of its own, and leaves the training to the framework, which has none of that name.
#include <lgabench/learning/cloning_method.hpp>

#include "../fixture.hpp"

namespace {

using namespace lgabench;

class OwnNetwork : public CloningMethod {
 public:
  Needs needs(const Json&) const override { return {Needs::Targets::truth}; }
  Selection select(const Command&, const FeatureSpace&, Services&) override { return {}; }

 protected:
  PolicyInputs inputs(const Json&) const override { return {{PolicyInputs::Picture::rgb}}; }
};

}  // namespace

LGABENCH_METHOD("fixture_own_network", "0.1", "has a network of its own name", OwnNetwork,
                "{" LGABENCH_TRAINING_OPTIONS R"(,
  "loss": {"default": "norm", "values": ["norm"], "help": "its own", "source": "test fixture"},
  "network": {"default": "resnet", "values": ["resnet"], "help": "its own", "source": "test fixture"}})")
