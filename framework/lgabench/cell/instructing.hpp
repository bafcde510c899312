// What a policy is told in each test scene, and what is recorded of it in a perturbed cell.
#pragma once
#include <string>
#include <vector>

#include <lgabench/cell/evaluator.hpp>
#include <lgabench/core/method.hpp>
#include <lgabench/record/cell.hpp>
#include <lgabench/record/perturbed.hpp>

namespace lgabench {

/// The instruction of the scene's command, with the errors that its arm's perturbation makes in the Selection.
Instruction instruction_in(const Scene& scene, const Scenario& scenario, const Cell& cell,
                           const std::vector<Instruction>& instructions);

/// perturbed.jsonl as it grows: hashes of what an actor is given first in each episode of the cell.
class PerturbedLines final : public Recorder {
 public:
  /// `selected`: an instruction for each command, before perturbations. `policy` is null for a reference row. All
  /// arguments outlive this object.
  PerturbedLines(const Scenario& scenario, const Cell& cell, const std::vector<Instruction>& selected,
                 const Policy* policy)
      : scenario_(scenario), cell_(cell), selected_(selected), policy_(policy) {}

  void given(const Environment& environment, const Given& given) override;
  void acted() override;

  const std::vector<PerturbedEpisode>& episodes() const { return episodes_; }
  std::string text() const;

 private:
  const Scenario& scenario_;
  const Cell& cell_;
  const std::vector<Instruction>& selected_;
  const Policy* const policy_;
  std::vector<PerturbedEpisode> episodes_;
  bool is_first_ = false;  // the step that was given last, of its episode
};

/// Where an axis gives other commands: notes what each episode took, in the scene's own control as in every arm.
void note_takings(const Scenario& scenario, const Cell& cell, const std::vector<TestScene>& tests,
                  std::vector<Episode>& episodes);

}  // namespace lgabench
