// Stands in for a language model where nobody is asked: --answers none.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/language_model.hpp>

namespace lgabench {

/// Refuses every question with InputError, and has no hypotheses.
class Nobody : public LanguageModel {
 public:
  std::vector<bool> answer(const Command& command, const FeatureSpace&, const std::vector<Question>&) override;
  Meaning mean(const Command& command, const FeatureSpace&) override;
  std::vector<Hypothesis> hypotheses(const Command&, const FeatureSpace&) override { return {}; }
  std::string model() const override { return "none"; }
  Provenance provenance() const override { return Provenance::none; }
  SelectionCost cost() const override { return {}; }
};

}  // namespace lgabench
