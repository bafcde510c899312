// What perturbations changed in the episodes of a cell, and whether that is what their axes declare.
#pragma once
#include <optional>
#include <vector>

#include <lgabench/cell/evaluator.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/record/perturbed.hpp>

namespace lgabench {

/// In what share of episodes a part that an axis changes is another one, at least.
constexpr double fewest_changed = .95;

/// A scene as it was played.
struct PlayedScene {
  const Scene& scene;
  std::vector<EngineBody> bodies;  // at its beginning
  const Scene& control;            // which it was made from
};

/// The parts of an episode that a policy sees as `observation`, or is given as what was `read` of it, told `told` where
/// `selected` was selected. A reference row has neither.
std::array<std::string, parts> parts_of(const PlayedScene& played, const Observation& observation,
                                        const Instruction* selected, const Instruction* told,
                                        const Observation* read = nullptr);

/// Hash of ids, and of the id, type and texture of each instance.
std::string names_hash(const Observation& observation);

/// Expects of every axis of the scenario's arms that parts which it does not declare are the control's, to the bit, and
/// that a part which it changes is another one in at least 95 % of its arm's episodes. `actions`: whether a policy
/// acts, whose action must be the control's, to the bit, where its input is. `episodes` as evaluate() returned them,
/// those of the control first. Where an axis leaves picture, ids and instances as they are, what is read of them must
/// be the same too.
/// @throws EngineError that names axis, part and episode; MethodError where the policy is at fault, or a plugin whose
/// axis it is.
void expect_declared(const std::vector<PerturbedEpisode>& parts, const std::vector<Episode>& episodes, bool actions,
                     const Scenario& scenario);

}  // namespace lgabench
