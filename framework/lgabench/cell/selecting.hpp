// A cell's Selections, from what the method says of the words alone to what is learned from and acted on.
#pragma once
#include <string>
#include <vector>

#include <lgabench/cell/steps.hpp>
#include <lgabench/record/cell.hpp>

namespace lgabench {

/// The method's Selections for the commands of a scenario, at three stages: as select() returned them, as revise() left
/// them, and with the errors that the cell asks for. Errors are made once, in what the method selects last.
class Selecting {
 public:
  /// Asks `method` for each command; null selects nothing and needs the truth. `scenario` and `cell` outlive this
  /// object.
  /// @throws as select(), and as expect_usable().
  Selecting(Method* method, const Scenario& scenario, const Cell& cell, Services& services);

  /// What is shown, learned from and acted on, as far as it is decided.
  const Selected& current() const { return current_; }
  /// Whether a demonstrated command's Selection keeps nothing: there is nothing to show or to learn from.
  bool nothing_to_learn_from() const { return current_.nothing_to_learn_from(scenario_); }
  /// Whether every Selection comes from somebody, so that a failure can be attributed to it.
  bool is_attributable() const;

  /// Asks the method, if it revises, for each command's Selection with what was shown; `demonstrations` then have the
  /// new instructions. @throws as revise().
  void revise(Method& method, std::vector<Demonstration>& demonstrations, const std::vector<Scene>& scenes,
              Services& services);
  /// Steps' learn(), whose questions are added to the first Selection's cost.
  std::unique_ptr<Policy> learn(Method& method, const std::vector<Demonstration>& demonstrations, Services& services);

  /// selection.json.
  std::string text() const;

 private:
  void make_errors();

  const Scenario& scenario_;
  const Cell& cell_;
  Selected current_;
  std::vector<Instruction> initial_, without_errors_;
};

}  // namespace lgabench
