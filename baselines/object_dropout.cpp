// No abstraction: in copies of each step every object is painted over by the flip of a coin, so that no single one
// tells the action. After OREO (Park et al., NeurIPS 2021, arXiv 2110.14118): objects by their ids in place of learned
// codes.
#include <lgabench/abstraction/repaint.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

using namespace lgabench;

class ObjectDropout : public CloningMethod {
 public:
  Needs needs(const Json&) const override {
    Needs needs{Needs::Targets::truth};
    needs.shadows = true;
    return needs;
  }
  Selection select(const Command&, const FeatureSpace&, Services&) override { return {}; }
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    background_ = usual_background(demonstrations);
    return CloningMethod::learn(demonstrations, services);
  }

 protected:
  PolicyInputs inputs(const Json&) const override {
    return {{PolicyInputs::Picture::rgb}, PolicyInputs::Text::utterance};
  }
  int copies(const Json& options) const override { return options.at("copies").get<int>(); }
  void augment(Step& step, const Selection&, int, RandomStream& stream) const override {
    Ids dropped;
    for (const Instance& instance : step.observation.instances)
      if (stream.coin()) dropped.push_back(instance.id);
    step.observation = repaint(std::move(step.observation), dropped, background_);
  }

 private:
  Background background_;
};

LGABENCH_METHOD("object_dropout", "0.1", "Behaviour cloning on the picture, with objects painted over at random",
                ObjectDropout, "{" LGABENCH_CLONING_OPTIONS "," LGABENCH_NO_MASK_OPTIONS "," LGABENCH_COPIES_OPTION R"(,
  "copies": {"default": 8, "min": 1, "max": 64, "help": "of each step, each without some of the objects", "source": "ours"}})")
