// Human: as LGA, with a Selection that a person specified from scratch (paper, section 5).
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

class Human : public lgabench::CloningMethod {
 public:
  lgabench::Selection select(const lgabench::Command& command, const lgabench::FeatureSpace&,
                             lgabench::Services& services) override {
    return services.human.specify(command);
  }
};

LGABENCH_METHOD_ASKING("specify", "human", "0.1", "Behaviour cloning on the goal mask of what a person specified",
                       Human, "{" LGABENCH_CLONING_OPTIONS "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}")
