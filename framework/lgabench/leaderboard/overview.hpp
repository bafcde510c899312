// The board's first page: every method in every suite, a table for each ranking.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include <lgabench/leaderboard/suite_page.hpp>

namespace lgabench::leaderboard {

using Suites = std::vector<std::pair<std::string, std::vector<NamedTable>>>;

/// index.html, without what the board's words mean.
report::Document overview(const Suites& suites);
/// What its script needs: the rankings as tabs.
Json overview_data(const Suites& suites);
/// "How to enter", with links from the board.
report::Section how_to_enter();

}  // namespace lgabench::leaderboard
