// What a scenario of this environment says of its scenes.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/scenario.hpp>

namespace lgabench::mobile {

/// What scenes of one kind hold. Targets are drawn from the command's truth, or from the Selection in training.
struct Content : SceneContent {
  std::vector<std::string> distractor_types;
  std::pair<int, int> distractors{1, 3};  // fewest and most, all numbers with equal odds
  /// The target is of another type than the first demonstration's, and .10 to .25 from where that one stood.
  bool near_first = false;
  /// Others may be right as well: drawn from the truth's types and the distractors'.
  bool several_right = false;
  double least_visible = .9;            // share of the target's pixels
  std::optional<double> caption_error;  // how likely the captioner errs; none: perception is perfect
};

const Content& content_of(const Scenario& scenario, const std::string& arm);

/// @throws InputError for a number outside of [0, 1].
double read_share(const JsonReader& reader);

std::vector<std::string> scenario_members();
std::vector<std::string> scene_members();
Content read_content(const Scenario& scenario, const JsonReader& file, const JsonReader* scenes, bool training);

}  // namespace lgabench::mobile
