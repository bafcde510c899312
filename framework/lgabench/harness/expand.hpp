// From a grid to the cells of a run.
#pragma once
#include <string>
#include <vector>

#include <lgabench/abstraction/participant.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/job/cell.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// What is not on the grid.
struct Variation {
  std::string answers = "recorded";  // as Cell::answers
  Json options = Json::object();     // as Grid::options, before which they go
  bool references = true;            // add the reference rows
  Truth truth = Truth::released;
  std::vector<Participant> participants{};  // none: the truth stands in for people
};

/// Every cell of the grid: scenario by scenario, reference rows after the methods. With participants a cell of a
/// method that asks people for each one who specified, or edited, all commands of the scenario; none where nobody did.
/// @throws as competitors(); PluginError for an unknown engine, InputError for a method that no participant answered at
/// all.
std::vector<Cell> expand(const Suite& suite, const Grid& grid, const Variation& variation, const Catalogue& catalogue);

}  // namespace lgabench
