// From a run to entries of the leaderboard, or to the reasons why it is none.
#pragma once
#include <string>
#include <vector>

#include <lgabench/leaderboard/entry.hpp>

namespace lgabench::leaderboard {

struct Added {
  std::vector<std::string> entries;   // paths of new ones, relative to the board
  std::vector<std::string> evidence;  // of those that were there with the same outcomes, and got a line of evidence
  std::vector<std::string> refused;   // why nothing was written, a line each; then the others are empty
};

/// Adds the rows of a run: those named in `rows`, or all. `about`: what its authors say (docs/formats). Writes all of
/// them or none; of those that a killed call would have written, the next one writes the rest.
/// @throws InputError for a run that cannot be read, an `about` that is not as docs/formats says, and a row that the
/// run does not have.
Added add_run(const fs::path& board, const fs::path& run, const Json& about, const std::vector<std::string>& rows);

}  // namespace lgabench::leaderboard
