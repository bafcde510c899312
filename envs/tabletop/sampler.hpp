// From a scenario to scenes.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/scenario.hpp>

namespace lgabench::tabletop {

/// All that a scene depends on (docs/protocol.md, section 3): not engine, method, thread or host.
struct SceneRequest {
  std::string layout;  // one of layouts(task)
  std::string split;   // train, dev or test
  std::string arm;     // of the scenario's tests, or "train" for training scenes
  std::uint64_t seed = 0;
  /// Of training targets and obstacles where the scenario leaves them to the method: one a command, only target and
  /// avoid count. Empty: the truth.
  std::vector<Selection> selections = {};
  /// Of test scenes that one training seed has to itself: part of their random streams. None: shared by all seeds.
  std::optional<std::uint64_t> training_seed = {};
};

/// Scene number `index`. Layout, target features, distractors and ids come from separate random streams, so that two
/// distributions, and a scenario's arms, share target places. (In `continuous`, where a target's shape does not fit,
/// the next place is tried. For sweep it shifts the target only.)
/// @throws InputError where layout, split or arm is unknown, or the distribution holds nothing that the layout can
/// show.
Scene sample_scene(const Scenario& scenario, const SceneRequest& request, int index);

/// The layouts in which this task can be sampled.
std::vector<std::string> layouts(Task task);

}  // namespace lgabench::tabletop
