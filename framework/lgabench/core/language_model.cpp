#include <lgabench/core/language_model.hpp>

namespace lgabench {

Meaning LanguageModel::mean(const Command& command, const FeatureSpace&) {
  throw MethodError(model() + ": expected a source that says what \"" + command.utterance +
                    "\" means in one answer (meaning=structured)");
}

}  // namespace lgabench
