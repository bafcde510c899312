// Pictures of the scenes in which a method failed, drawn by lgabench-worker: the report links no renderer.
#pragma once
#include <map>
#include <string>

#include <lgabench/report/results.hpp>

namespace lgabench::report {

constexpr std::size_t most_pictures = 150;  // in one page: about 4 MB

struct Pictures {
  std::map<std::string, std::string> scenes;  // the scene's hash -> PNG in base64, of the scene before the action
  std::map<std::string, std::string> masks;   // mask_key -> PNG in base64
  std::size_t wanted = 0;                     // scenes in which a method failed
  std::string problem;                        // why one that was asked for is missing; empty if none is
};

/// Names the goal mask that a Selection leaves of a scene: equal for Selections of one distribution.
std::string mask_key(const std::string& scene, const Json& selection);

/// Draws the first most_pictures scenes, by index, so that each scenario has its share. A worker that is missing or
/// fails is the Pictures' problem, not an error.
Pictures draw_pictures(const fs::path& run, const RunResults& results);

}  // namespace lgabench::report
