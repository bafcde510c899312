// Feature abstraction phi -> phi-hat with a language model (paper, section 3.1).
#pragma once
#include <lgabench/core/method.hpp>

namespace lgabench {

/// The questions of select_features(), in their order.
std::vector<Question> feature_questions(const Command& command, const FeatureSpace& space);

/// Asks of every object type and every texture of the space whether the target could have it, and the same
/// of the task's second set where it has one: one question a candidate. The Selection holds what was answered yes, in
/// the space's order, with the model's provenance and what these questions cost.
/// @throws MethodError if the model leaves a question unanswered.
Selection select_features(const Command& command, const FeatureSpace& space, LanguageModel& model);

/// Asks what the command means, in one question; of the task's second set, where it has one, as select_features() does.
/// The Selection is empty where the model gave no meaning that can be read. @throws MethodError as select_features().
Selection select_meaning(const Command& command, const FeatureSpace& space, LanguageModel& model);

/// Calls select_features(), select_meaning() or select_named(), as `meaning` says: "flat", "structured" or "named"
/// (LGABENCH_MEANING_OPTION).
Selection select_as_asked(const std::string& meaning, const Command& command, const FeatureSpace& space,
                          LanguageModel& model);
/// Does so as the option `meaning` of services.options says.
Selection select_as_asked(const Command& command, const FeatureSpace& space, Services& services);

}  // namespace lgabench
