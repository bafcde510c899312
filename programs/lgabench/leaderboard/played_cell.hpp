// From a cell of a run to an entry's line.
#pragma once
#include <lgabench/leaderboard/entry.hpp>
#include <lgabench/statistics/results.hpp>

namespace lgabench::leaderboard {

/// The line of a cell that finished, or that its method failed. `directory` is the cell's, `key` that of a run of its
/// row alone. Its Selections are added to the entry's, unless they are there. @throws InputError for files that are not
/// as docs/formats says.
PlayedCell played_cell(const statistics::CellResult& result, const fs::path& directory, const std::string& key,
                       Entry& entry);

}  // namespace lgabench::leaderboard
