// The entries that rows of a run would be on a board.
#pragma once
#include <string>
#include <vector>

#include <lgabench/leaderboard/entry.hpp>

namespace lgabench::leaderboard {

struct RowEntries {
  std::vector<Entry> entries;        // of the rows that are as a board takes them
  std::vector<std::string> refused;  // why others are not, a line each
};

/// Reads the rows of a run: those named in `rows`, or all. `about`: what its authors say (docs/formats), of which
/// /by is who computed it. @throws InputError for a row that the run does not have.
RowEntries row_entries(const fs::path& run, const Json& about, const std::vector<std::string>& rows);

}  // namespace lgabench::leaderboard
