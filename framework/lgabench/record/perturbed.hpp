// An episode of a run with perturbations, and its line of perturbed.jsonl: what differs from the control's.
#pragma once
#include <array>
#include <optional>
#include <string>

#include <lgabench/core/json.hpp>
#include <lgabench/core/perturbations.hpp>

namespace lgabench {

struct PerturbedEpisode {
  std::string arm;
  int index = 0;
  std::string axis;  // "" in the control
  int level = 0;
  /// Hash of each part, in the order of EpisodePart; "" where the episode has no such part.
  std::array<std::string, parts> hashes;
  std::string
      read{};  // of the pictures and texts that the policy says it made its action of; "" where it does not tell
  double target_scale = 1;  // the target's size, times its type's
  std::string names{};      // hash of ids and names as they were read; "" where nothing was
};

/// {"arm", "index", "axis", "level", "objects": HASH, ..., "read", "target_scale"}; null for "".
Json to_json(const PerturbedEpisode& episode);
/// @throws InputError
PerturbedEpisode read_perturbed_episode(const JsonReader& reader);

}  // namespace lgabench
