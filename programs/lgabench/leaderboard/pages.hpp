// What people look at, made from the entries alone: README.md, leaderboard.csv, index.html, a page for each suite, and
// the tables in documents that people write.
#pragma once
#include <map>
#include <string>
#include <vector>

#include <lgabench/leaderboard/standings.hpp>

namespace lgabench::leaderboard {

/// The bytes of each file that is made: the board's, and `documents` (or all Markdown of a folder), in which the tables
/// of a preset stand between <!-- board:SUITE-PRESET --> and <!-- /board -->, and the steps of all suites between
/// <!-- board:steps --> and that. The same entries give the same bytes.
/// @throws InputError for a document without such a pair, and for what else of the board is not as docs/formats says,
/// before anything is computed.
std::map<fs::path, std::string> made_files(const fs::path& board, const std::vector<Entry>& entries,
                                           const std::vector<fs::path>& documents, const OnProgress& on_progress = {});

/// Reads the entries and writes these files, and entries of 0.4 and earlier in the short form (said.hpp); pages of
/// suites that are gone and answers that no entry names are removed, and what a killed writer left. Returns the paths
/// of those that changed. @throws InputError as read_entry() and made_files()
std::vector<fs::path> build(const fs::path& board, const std::vector<fs::path>& documents = {},
                            const OnProgress& on_progress = {});

}  // namespace lgabench::leaderboard
