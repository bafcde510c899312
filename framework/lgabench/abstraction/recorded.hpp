// A language model's published answers, replayed.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/language_model.hpp>

namespace lgabench {

/// Answers from the data directory's answers/: a candidate is answered yes exactly if it is listed there.
/// Costs one query a question, as the live model did, and no seconds: the paper published none.
class RecordedLanguageModel : public LanguageModel {
 public:
  /// `answers` is "gpt4" (the user study's nine scenarios, found by the scenario's id, often worded differently),
  /// "claude" (found by the utterance), or "recorded": GPT-4's where it was asked, else Claude's.
  /// `scenario` is the id that GPT-4's answers are looked up by; "" if there is none.
  /// @throws InputError for another word. Answers are looked up when they are asked for.
  RecordedLanguageModel(FeatureSpace space, std::string scenario, std::string answers);

  /// @throws InputError where nothing is recorded for the command: says what is; MethodError for a candidate outside
  /// the space, or for an object to be avoided that the model was not asked about.
  std::vector<bool> answer(const Command& command, const FeatureSpace& space,
                           const std::vector<Question>& questions) override;
  /// Of the command asked last.
  std::string model() const override { return model_; }
  std::string asked_as(const Command& command) const override;
  /// Always recorded.
  Provenance provenance() const override { return Provenance::recorded; }
  SelectionCost cost() const override { return cost_; }

 private:
  struct Recorded {
    Selection yes;  // the candidates answered yes
    std::string asked_as, model;
  };
  const Recorded& find(const std::string& utterance) const;
  std::optional<Recorded> find_gpt4() const;
  std::optional<Recorded> find_claude(const std::string& utterance) const;

  FeatureSpace space_;
  std::string scenario_, answers_, model_;
  mutable std::map<std::string, Recorded> found_;  // by utterance: the files are read once for each
  SelectionCost cost_;
};

}  // namespace lgabench
