// The abstraction in the input, with the colours of what it keeps: all else, shadows too, has the table's colour. After
// the masks of ARRO (2025) and PEEK (arXiv 2509.18282), without their path annotations, videos and pretrained policies.
#include <lgabench/abstraction/repaint.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

using namespace lgabench;

class MaskedRgb : public CloningMethod {
 public:
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    return select_as_asked(command, space, services);
  }
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    table_ = most_frequent_colour(usual_background(demonstrations));
    return CloningMethod::learn(demonstrations, services);
  }

 protected:
  PolicyInputs inputs(const Json&) const override {
    PolicyInputs inputs{{PolicyInputs::Picture::rgb}};
    inputs.of_demonstrations = true;
    inputs.prepare = [table = table_](const Observation& seen, const Selection& selection, Phase) {
      Ids others = unselected(seen, selection);
      others.push_back(0);
      return repaint(seen, others, table);
    };
    return inputs;
  }

 private:
  Colour table_{};
};

LGABENCH_METHOD("masked_rgb", "0.1",
                "Behaviour cloning on the colours of what a language model selected, and no others", MaskedRgb,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                "," LGABENCH_NO_MASK_OPTIONS "}")
