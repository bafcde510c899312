// A language model's published answers, replayed.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/language_model.hpp>

namespace lgabench {

/// Answers from the data directory's answers/: a candidate is answered yes exactly if it is listed there.
/// Asked for one scenario's command; costs one query a question, as the live model did, and no seconds: the paper
/// published none.
class RecordedLanguageModel : public LanguageModel {
 public:
  /// `answers` is "gpt4" (the user study's nine scenarios, found by the scenario's id, often worded differently),
  /// "claude" (found by the utterance, any scenario's id), or "recorded": GPT-4's where it was asked, else Claude's.
  /// Only the scenario's id, command and space are read.
  /// @throws InputError for another word, and where nothing is recorded for the scenario: says what is.
  RecordedLanguageModel(const Scenario& scenario, const std::string& answers);

  /// @throws MethodError for another command than the scenario's, for a candidate outside its space, or for an object
  /// to be avoided that the model was not asked about.
  std::vector<bool> answer(const Command& command, const FeatureSpace& space,
                           const std::vector<Question>& questions) override;
  std::string model() const override { return model_; }
  std::string asked_as(const Command& command) const override;
  Provenance provenance() const override { return Provenance::recorded; }
  SelectionCost cost() const override { return cost_; }

 private:
  bool find_gpt4(const Scenario& scenario);
  bool find_claude(const Scenario& scenario);
  void expect_own(const Command& command) const;

  std::string utterance_, asked_as_, model_;
  FeatureSpace space_;
  Selection yes_;  // the candidates answered yes
  SelectionCost cost_;
};

}  // namespace lgabench
