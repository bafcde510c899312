// What continuous integration runs over the board: files alone, nothing is played.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/files.hpp>

namespace lgabench::leaderboard {

struct Checked {
  std::size_t entries = 0;
  std::vector<std::string> problems;  // a line each
  std::vector<std::string> notes;     // what could not be checked, and why
};

/// Schema, identity and completeness of every entry; that entries of one table played the same scenes; that cassettes
/// are there; that what vouched.json lists is there; that the pages and the tables in `documents` are those of the
/// entries; and, with a revision of git, that no outcome of it changed and no entry of it is gone. Keeps on after a
/// problem.
Checked check(const fs::path& board, const std::string& against = "", const std::vector<fs::path>& documents = {});

}  // namespace lgabench::leaderboard
