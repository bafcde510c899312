// An entry's cells computed anew, in the place of cells that no build gives any more: by the board's maintainers.
#pragma once
#include <string>
#include <vector>

#include <lgabench/leaderboard/entry.hpp>

namespace lgabench::leaderboard {

struct Superseded {
  std::vector<std::string> entries;  // places of those with new cells, relative to the board
  std::vector<std::string> same;     // of those that have the run's results already, to the bit
  std::vector<std::string> refused;  // why nothing was written, a line each; then the others are empty
};

/// Takes the cells of a run's rows, those named in `rows` or all, for the entries that these rows are on the board.
/// Each entry's files go to superseded_place() as they are; in its place comes one of the same identity and authors,
/// without verifications, whose /supersedes names them with `when` and `reason`. What the maintainers said of the old
/// one, and its pictures, are dropped. Writes all or none; what a killed call left to do, the next one does.
/// @throws InputError as row_entries() and read_entry().
Superseded supersede(const fs::path& board, const fs::path& run, const std::vector<std::string>& rows,
                     const std::string& by, const std::string& reason, const std::string& when);

}  // namespace lgabench::leaderboard
