// What labels, language and the truth add (statistics/steps.hpp), from the entries of one table.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include <lgabench/document/document.hpp>
#include <lgabench/leaderboard/standings.hpp>
#include <lgabench/leaderboard/undisputed.hpp>
#include <lgabench/statistics/steps.hpp>

namespace lgabench::leaderboard {

struct BoardSteps {
  MainColumn main;
  std::array<double, 4> success{};                    // of each stage
  std::array<std::optional<double>, 4> undisputed{};  // likewise
  std::array<statistics::Step, 3> steps;              // a command of a step is a scenario here
};

/// Of rows that place what they learned by a heat map, with equal options and shipped answers. None where one of the
/// four is not among them, or the preset lacks the suite's main arm. Of several rows with such options the one with the
/// `frozen` answers (Track::answers) counts.
std::optional<BoardSteps> steps_of(const std::vector<Standing>& table, const std::string& frozen = "",
                                   const std::optional<Undisputed>& undisputed = {});

/// The steps as a table; `name` is the file's that a page offers.
document::Grid steps_grid(const BoardSteps& steps, const std::string& suite, const std::string& name);

}  // namespace lgabench::leaderboard
