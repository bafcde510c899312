// What a person would select, where no person was asked.
#pragma once
#include <vector>

#include <lgabench/core/language_model.hpp>

namespace lgabench {

/// Stands on the true distribution: an upper bound, no human data, and no human seconds.
class TruthAsHuman : public HumanAnswers {
 public:
  /// `commands` of the scenario, with their truth.
  explicit TruthAsHuman(std::vector<ScenarioCommand> commands);

  /// The command's true distribution; provenance truth. @throws MethodError for a command that the scenario lacks.
  Selection specify(const Command& command) override;
  /// The proposal with its object types corrected to the true ones, its textures and its cost kept: the study's people
  /// mostly did that (PROTOCOL, section 5). Provenance simulated_edit.
  Selection edit(const Command& command, const Selection& proposal) override;

 private:
  const Selection& truth_of(const Command& command) const;

  std::vector<ScenarioCommand> commands_;
};

}  // namespace lgabench
