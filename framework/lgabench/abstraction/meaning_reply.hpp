// How a language model's reply that says a meaning, or several, is read.
#pragma once
#include <string>

#include <lgabench/core/language_model.hpp>

namespace lgabench {

/// The JSON object that follows the reply's last "final answer", or its last one where it has none; what a model
/// thought aloud before "</think>" does not count. @throws MethodError, in a line, where there is none or where it is
/// no meaning in the space.
Meaning meaning_in(const std::string& reply, const FeatureSpace& space);

/// What the reply's object {"hypotheses": [{"text", "meaning"}, ...]} says; it is found as in meaning_in().
/// @throws MethodError as meaning_in().
std::vector<Hypothesis> hypotheses_in(const std::string& reply, const FeatureSpace& space);

}  // namespace lgabench
