// Who answers a method that is used outside of a run: to check it, or to say how long it takes.
#pragma once
#include <string>
#include <vector>

#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/cell/steps.hpp>
#include <lgabench/host/host_session.hpp>

namespace lgabench {

/// Counts what is asked; or answers no to everything, as a model that sees nothing fitting would.
class CountingModel : public LanguageModel {
 public:
  CountingModel(LanguageModel& model, bool always_no) : model_(model), always_no_(always_no) {}
  std::vector<bool> answer(const Command& command, const FeatureSpace& space,
                           const std::vector<Question>& questions) override;
  Meaning mean(const Command& command, const FeatureSpace& space) override;
  std::vector<Hypothesis> hypotheses(const Command& command, const FeatureSpace& space) override;
  std::string model() const override { return model_.model(); }
  std::string asked_as(const Command& command) const override { return model_.asked_as(command); }
  Provenance provenance() const override { return model_.provenance(); }
  SelectionCost cost() const override { return model_.cost(); }

  int asked = 0;

 private:
  LanguageModel& model_;
  bool always_no_;
};

/// Answers with the truth, where nobody's answers are recorded.
class TruthfulModel : public LanguageModel {
 public:
  explicit TruthfulModel(const std::vector<ScenarioCommand>& commands) : truth_(commands) {}
  std::vector<bool> answer(const Command& command, const FeatureSpace& space,
                           const std::vector<Question>& questions) override;
  std::vector<Hypothesis> hypotheses(const Command&, const FeatureSpace&) override { return {}; }
  std::string model() const override { return "true distribution"; }
  Provenance provenance() const override { return Provenance::truth; }
  SelectionCost cost() const override { return {}; }

 private:
  TruthAsHuman truth_;
};

/// Whom the job's method may ask in a scenario, as in a cell without people and with recorded answers, where there are
/// some for every command. Borrows `scenario` and `job`.
struct Answering {
  /// `demonstrations`: of each command. `always_no`: the model answers so.
  Answering(const Scenario& scenario, const HostJob& job, int demonstrations, bool always_no = false);

  Scenario asked;  // its people
  RecordedLanguageModel recorded;
  TruthfulModel truthful;
  CountingModel model;
  DeclaredHuman human;
  TrainingLines log;
  Services services;
};

}  // namespace lgabench
