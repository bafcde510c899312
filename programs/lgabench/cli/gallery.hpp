// Contact sheets: all that a scene can show, side by side, for a person to look at. Without text, since a font would be
// the longest file of the verb: names are in a table beside the sheet.
#pragma once
#include <string>

#include <lgabench/core/scenario.hpp>

namespace lgabench::cli {

struct Sheet {
  std::string png;
  std::string legend;  // a Markdown table, cell by cell what the sheet shows
  Json cells;          // where the pictures lie: {"names", "tile", "step", "across"}, row by row, in pixels
};

/// `what`: "objects" (every type), "textures" (every one), both as the environment's showcase says, "scenes" (a test
/// scene of every scenario, with its goal mask), "words" or an environment (likewise), "perturbations" (one along every
/// axis at every level, where that shows), or a file: the objects of a JSON list of {"scenario", "object_type",
/// "texture"}, each alone in its scenario's environment. Twice the observation's size, or as large. @throws InputError
/// for anything else.
Sheet gallery(const std::string& what);

/// A scene's beginning: as a policy sees it where its arm has a perturbation, else as it is.
Observation drawn_in_arm(const Scenario& scenario, const Scene& scene);

/// A test scene of every arm of the scenario in that layout, with its goal mask.
Sheet scene_sheet(const Scenario& scenario, const std::string& layout);

}  // namespace lgabench::cli
