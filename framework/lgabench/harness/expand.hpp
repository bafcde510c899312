// From a design to the cells of a run.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/abstraction/participant.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/cell.hpp>

namespace lgabench {

/// The arms that are asked for, in place of all. Each scenario's first one is played with them, as their control.
struct PlayedArms {
  std::vector<DesignAxis> axes;  // perturbations; without levels all that there are
  std::vector<std::string> arms;
};
Json to_json(const PlayedArms& played);

/// What is not part of the design.
struct Variation {
  AnswerSource answers;
  Json options = Json::object();  // as Design::options, before which they go
  bool references = true;         // add the reference rows
  Truth truth = Truth::released;
  std::vector<Participant> participants{};  // none: the truth stands in for people
  std::optional<PlayedArms> played{};       // none: all
};

/// A cell of the design without its layout, engine, method, demonstrations and training seed.
Cell unplayed_cell(const Suite& suite, const Design& design, const Scenario& scenario, const AnswerSource& answers);

/// Whether the row has a cell for every number of demonstrations and training seed. A reference row that learns nothing
/// has one, with no demonstrations, for each set of test scenes.
bool learns(const Competitor& row);

/// Every cell of the design: scenario by scenario, reference rows after the methods. With participants a cell of a
/// method that asks people for each one who specified, or edited, all commands of the scenario; none where nobody did.
/// @throws as competitors(); PluginError for an unknown engine, InputError for a layout that a scenario lacks, for a
/// method that no participant answered at all, for participants whom no method asks, and for arms to be played that
/// there are none of.
std::vector<Cell> expand(const Suite& suite, const Design& design, const Variation& variation,
                         const Catalogue& catalogue);

}  // namespace lgabench
