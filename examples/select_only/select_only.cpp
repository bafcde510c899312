// The smallest method: it only says which features matter. Demonstrations, network and training are lgabench's.
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

using namespace lgabench;

// A feature matters if a word of the command begins with the feature's first word; if no feature does, all matter.
std::vector<std::string> named(const Command& command, const std::vector<std::string>& features) {
  std::vector<std::string> found;
  for (const std::string& feature : features)
    if (command.utterance.find(' ' + feature.substr(0, feature.find(' '))) != feature.npos) found.push_back(feature);
  return found.empty() ? features : found;
}

class SelectOnly : public CloningMethod {
 public:
  Selection select(const Command& command, const FeatureSpace& space, Services&) override {
    Selection selection;
    selection.target = {named(command, space.object_types), named(command, space.textures)};
    return selection;
  }
};

LGABENCH_METHOD("select_only", "0.1", "Keeps what the command names", SelectOnly,
                "{" LGABENCH_CLONING_OPTIONS "," LGABENCH_MASK_OPTIONS "}")
