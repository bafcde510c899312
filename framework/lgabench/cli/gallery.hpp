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

/// `what`: "objects" (every type), "textures" (every one, on a pallet) or "scenes" (a test scene of every scenario,
/// with its goal mask). Twice the observation's size. @throws InputError for anything else.
Sheet gallery(const std::string& what);

/// A test scene of every arm of the scenario in that layout, with its goal mask.
Sheet scene_sheet(const Scenario& scenario, const std::string& layout);

}  // namespace lgabench::cli
