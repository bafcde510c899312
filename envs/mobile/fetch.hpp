// Scenes of the task fetch: an object among others that are like it, a receiver among others.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <common/scene_members.hpp>
#include <lgabench/core/environments.hpp>

namespace lgabench::mobile {

/// The role of the receiver that the command means, which is the second set's name too. The others are distractors.
constexpr const char* receiver = "receiver";

/// What scenes of one kind hold. Targets and receivers are drawn from the command's truth, or from the Selection in
/// training; every object has a texture that its type has in life (mobile/fetch_textures.json).
struct FetchContent : SceneContent {
  std::pair<int, int> distractors{7, 7};  // fewest and most other objects, all numbers with equal odds
  /// Among other objects and receivers: see docs/protocol.md, section 7. The sets say what the command nearly means:
  /// these types, or what it means but for one of these textures.
  std::optional<common::NearMiss> near_miss;
  double least_visible = .9;            // share of the target's pixels
  std::optional<double> caption_error;  // see perceive_in_bad_light(); none: perception is perfect
};

/// Names of the members of "train" and of "tests", as EnvironmentType asks for them.
std::vector<std::string> fetch_scene_members();

/// EnvironmentType::read_content().
FetchContent read_fetch_content(const Scenario& scenario, const JsonReader* scenes, bool training);

/// Scene number `index`. Target, receiver, others, places and ids come from separate random streams: arms that differ
/// in one share the rest. @throws as EnvironmentType::sample(); Error where no room is found.
Scene sample_fetch(const Scenario& scenario, const SceneRequest& request, int index);

/// So many objects stand beside the target at most, receivers apart.
constexpr int most_fetch_others = 7;

/// EnvironmentType::with_distractors(), in scenes of the task.
Scene fetch_with_distractors(const Scenario& scenario, const Scene& scene, int count, bool near_miss,
                             RandomStream random);

}  // namespace lgabench::mobile
