// The board's first page: every method in every suite, a table for each ranking. And what documents show of the board:
// the steps of all suites, and each table arm by arm.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include <lgabench/leaderboard/suite_page.hpp>

namespace lgabench::leaderboard {

using Suites = std::vector<std::pair<std::string, std::vector<NamedTable>>>;

/// index.html, without what the board's words mean.
document::Document overview(const Suites& suites);
/// What its script needs: the rankings as tabs.
Json overview_data(const Suites& suites);
/// "How to enter", with links from the board.
document::Section how_to_enter();

/// The first ranking of a preset, for a document from which `board` is the way to the board: each row's success in the
/// suite's main arm along the demonstrations with 95 % intervals over test scenes and training seeds, then in every arm
/// at the suite's main number of demonstrations, and the steps where their four rows are there. An oracle that always
/// succeeds has no row. Of perturbed scenes the ranking stands in their place.
void add_results(document::Section& section, NamedTable table, const fs::path& board);

/// A line for each table of the abstraction track that has the steps: success by what the policy is told, what language
/// adds to labels, and what is left between language and the truth.
document::Grid all_steps_grid(const Suites& suites);

}  // namespace lgabench::leaderboard
