// Pictures of the scenes in which a method failed, drawn by lgabench-worker: the report links no renderer.
#pragma once
#include <algorithm>
#include <map>
#include <string>

#include <lgabench/core/observation.hpp>
#include <lgabench/report/engines.hpp>
#include <lgabench/report/results.hpp>

namespace lgabench::report {

constexpr std::size_t most_pictures = 150;  // in one page: about 4 MB
constexpr std::size_t most_ends = 30;       // disagreements of engines that are shown

/// Of a picture a page shows every so manyth pixel, of its rows and of its columns.
constexpr int page_step(PictureSize picture) { return std::max(1, picture.columns / 256); }

struct Pictures {
  std::map<std::string, std::string> scenes;  // the scene's hash -> PNG in base64, of the scene before the action
  std::map<std::string, std::string> masks;   // mask_key -> PNG in base64
  std::map<std::string, std::string> ends;    // end_key -> PNG in base64
  std::size_t wanted = 0;                     // scenes in which a method failed
  std::string problem;                        // why one that was asked for is missing; empty if none is
};

/// Names the goal mask that the cell's method is shown of a scene: equal for Selections of one distribution.
std::string mask_key(const std::string& scene, const CellResult& cell, const Json& selection);

/// Names the picture of a scene after the action on `engine`; "": before it.
std::string end_key(const Disagreement& disagreement, const std::string& engine);

/// Draws the first most_pictures scenes, by index, so that each scenario has its share. A worker that is missing or
/// fails is the Pictures' problem, not an error.
/// And the ends of the first most_ends disagreements on both engines; one that cannot be loaded leaves no picture.
Pictures draw_pictures(const fs::path& run, const RunResults& results, const std::vector<EngineAgreement>& agreements);

}  // namespace lgabench::report
