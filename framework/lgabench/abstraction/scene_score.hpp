// Scores what a Selection keeps in test scenes, without a policy: the table of language models.
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <lgabench/core/language_model.hpp>
#include <lgabench/core/observation.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/scene.hpp>

namespace lgabench {

/// Sums over scenes, and over commands where they are added.
struct SceneScore {
  int commands = 0, exact_sets = 0;            // the same turns, and no pair wrong but undecided ones
  int scenes = 0, exact_scenes = 0;            // the instances kept as the target are exactly those that are meant
  int kept = 0, meant = 0, right = 0;          // instances of all scenes; right: kept and meant
  std::set<std::string> wrongly_kept, missed;  // object types, in words for a reader
};
SceneScore& operator+=(SceneScore& all, const SceneScore& more);

/// Adds a scene: `kept` are ids of objects that were kept, `astray` says that something else was kept too. What is
/// meant is what is in view of meant_at_first().
void add_scene(const Scene& scene, const Observation& seen, const std::vector<std::uint8_t>& kept, bool astray,
               SceneScore& score);

/// The command's Selection in `scenes` test scenes of each arm of the scenario that gives it, as a policy would see
/// them. A second set is not scored.
/// @throws as test_scene().
SceneScore score(const Scenario& scenario, int command, const Selection& selection, const std::string& layout,
                 std::uint64_t scene_seed, int scenes);

/// Adds a name to those who answered, in the order in which each answered last.
void add_source(const std::string& source, std::vector<std::string>& all);

/// Whether one of the hypotheses is the command's truth: the same rule, the same turns, and no pair of the space wrong
/// but those that the scenario calls undecided.
bool covers_truth(const std::vector<Hypothesis>& hypotheses, const Scenario& scenario, int command);

}  // namespace lgabench
