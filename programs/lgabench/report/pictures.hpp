// Pictures of test scenes, drawn by lgabench-worker: the report links no renderer and no engine.
#pragma once
#include <map>
#include <string>
#include <vector>

#include <lgabench/core/action.hpp>
#include <lgabench/document/document.hpp>
#include <lgabench/statistics/engines.hpp>
#include <lgabench/statistics/results.hpp>

namespace lgabench::report {
using namespace document;
using namespace statistics;

constexpr std::size_t most_pictures = 150;        // in one page: about 1 MB
constexpr std::size_t most_ends = 300;            // episodes whose end is shown: about 1 MB
constexpr std::size_t most_disagreements = 30;    // of engines that are shown
constexpr std::size_t most_read_bytes = 4 << 20;  // of pictures that policies read

struct Pictures {
  std::map<std::string, std::string> scenes;  // the scene's hash -> PNG in base64, of the scene before the action
  std::map<std::string, std::string> masks;   // mask_key -> PNG in base64
  /// The scene's hash -> PNG in base64 of it before and after its arm's perturbation, or where that leaves colours
  /// alone of its objects' ids. None where it leaves both.
  std::map<std::string, std::pair<std::string, std::string>> perturbed;
  std::map<std::string, Json>
      ends;  // end_key -> PNG in base64, "" where nothing moved; of several steps a list of these
  /// What a policy read, as it said itself: its pictures, as captions and indices of `seen`; texts that it read beside
  /// them; and what of the method's inputs it did not read.
  struct Input {
    std::vector<std::pair<std::string, std::size_t>> pictures;
    std::vector<std::string> texts, unread;
  };
  std::map<std::string, Input> inputs;  // by episode_key, for episodes in `scenes`
  std::vector<std::string> seen;        // PNG in base64, each once
  // The scene's hash -> the targets' outline, an SVG path in pixels; and its environment with what the oracle would do.
  std::map<std::string, std::string> targets;
  std::map<std::string, std::pair<std::string, Action>> oracle;
  std::size_t wanted = 0;  // scenes that a method played
  std::string problem;     // why one that was asked for is missing; empty if none is
};

/// Names the goal mask that the cell's method is shown of a scene: equal for Selections of one distribution.
std::string mask_key(const std::string& scene, const CellResult& cell, const Json& selection);

/// Names an episode of the cell.
std::string episode_key(const CellResult& cell, const std::string& arm, std::size_t index);

/// Names the picture of an episode's scene after its action on `engine`; "": before it.
std::string end_key(const CellResult& cell, const std::string& arm, std::size_t index, const std::string& engine);

/// Draws the first most_pictures scenes: one at each level of each perturbation, then those in which a method failed,
/// then by index, so that each scenario has its share; goal masks in these; and what policies read of them, as the
/// cells' shown.json has it. A worker that is missing or fails is the Pictures' problem, not an error. Plays most_ends
/// of the episodes in them again, so that each row has its share: the first failure and the first success of every row,
/// then the second ones, the most demonstrations first. And the ends of the first most_disagreements on both engines;
/// one that cannot be loaded leaves no picture.
Pictures draw_pictures(const fs::path& run, const RunResults& results, const std::vector<EngineAgreement>& agreements);

}  // namespace lgabench::report
