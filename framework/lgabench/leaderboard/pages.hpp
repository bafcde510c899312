// What people look at, made from the entries alone: README.md, leaderboard.csv, index.html and a page for each suite.
#pragma once
#include <map>
#include <string>
#include <vector>

#include <lgabench/leaderboard/standings.hpp>

namespace lgabench::leaderboard {

/// Each file of the board that is made, by its name. The same entries give the same bytes.
std::map<std::string, std::string> pages(const std::vector<Entry>& entries);

/// Reads the entries and writes their pages; pages of suites that are gone are removed. Returns the files' names.
std::vector<std::string> build(const fs::path& board);

}  // namespace lgabench::leaderboard
