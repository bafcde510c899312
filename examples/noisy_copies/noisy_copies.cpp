// A policy on pixels that learns from copies of each step, in which all that was not selected is noise. The example
// shows copies(), augment() and repaint(). Network, training and its number of steps are lgabench's.
#include <lgabench/abstraction/repaint.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

using namespace lgabench;

class NoisyCopies : public CloningMethod {
 public:
  Needs needs(const Json&) const override {
    Needs needs;
    needs.shadows = true;  // so that repaint() also covers the shadows of what it paints
    return needs;
  }
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    return select_features(command, space, services.lm);
  }

 protected:
  PolicyInputs inputs(const Json&) const override { return {{PolicyInputs::Picture::rgb}}; }
  int copies(const Json&) const override { return 5; }
  void augment(Step& step, const Selection& selection, int, RandomStream& stream) const override {
    const Ids others = unselected(step.observation, selection);
    step.observation = repaint(std::move(step.observation), others, Noise{stream});
  }
};

LGABENCH_METHOD("noisy_copies", "0.1", "Behaviour cloning on the picture, with noise on what was not selected",
                NoisyCopies, "{" LGABENCH_QUESTIONNAIRE LGABENCH_CLONING_OPTIONS "," LGABENCH_NO_MASK_OPTIONS "}")
