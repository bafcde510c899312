// What a person would select, where no person was asked.
#pragma once
#include <lgabench/core/language_model.hpp>

namespace lgabench {

/// Stands on the true distribution: an upper bound, no human data, and no human seconds.
class TruthAsHuman : public HumanAnswers {
 public:
  explicit TruthAsHuman(Selection truth);

  /// The true distribution; provenance truth.
  Selection specify(const Command& command) override;
  /// The proposal with its object types corrected to the true ones, its textures and its cost kept: the study's people
  /// mostly did that (PROTOCOL, section 5). Provenance simulated_edit.
  Selection edit(const Command& command, const Selection& proposal) override;

 private:
  Selection truth_;
};

}  // namespace lgabench
