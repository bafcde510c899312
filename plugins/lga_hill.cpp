// LGA-HILL: as LGA, with the language model's Selection edited by a person before it is used (paper, section 3.2).
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

class LgaHill : public lgabench::CloningMethod {
 public:
  lgabench::Selection select(const lgabench::Command& command, const lgabench::FeatureSpace& space,
                             lgabench::Services& services) override {
    return services.human.edit(command, lgabench::select_as_asked(command, space, services));
  }
};

LGABENCH_METHOD_ASKING("edit", "lga_hill", "0.1",
                       "Behaviour cloning on a language model's goal mask that a person edited", LgaHill,
                       "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                       "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}")
