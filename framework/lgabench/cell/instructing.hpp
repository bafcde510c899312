// What a policy is told in each test scene of a perturbed cell, and what is recorded of it.
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

/// `actor`, which appends to `episodes` hashes of what it is given in each. `policy` is null for a reference row, which
/// is given no instruction. `reading`: what the actor is given in place of what is seen; null: that. All arguments are
/// borrowed but these two.
Actor recording_actor(const Actor& actor, const Perception& reading, const Scenario& scenario, const Cell& cell,
                      const std::vector<Instruction>& instructions, const Policy* policy,
                      std::vector<PerturbedEpisode>& episodes);

/// perturbed.jsonl.
std::string perturbed_text(const std::vector<PerturbedEpisode>& episodes);

/// Where an axis gives other commands: notes what each episode took, in the scene's own control as in every arm.
void note_takings(const Scenario& scenario, const Cell& cell, const std::vector<TestScene>& tests,
                  std::vector<Episode>& episodes);

}  // namespace lgabench
