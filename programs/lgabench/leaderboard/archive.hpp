// The board as one file, for a repository that keeps it and gives it a DOI.
#pragma once
#include <lgabench/core/files.hpp>

namespace lgabench::leaderboard {

/// Writes `out`, a tar.gz of the board with README.md, CITATION.cff, LICENSE and the formats beside it. The same board
/// packed by the same lgabench, tar and gzip gives the same bytes: names are sorted, all times are when the newest
/// entry was computed. @throws InputError where the board has no entry, or tar fails. @pre check() found no problem
void write_archive(const fs::path& board, const fs::path& out);

}  // namespace lgabench::leaderboard
