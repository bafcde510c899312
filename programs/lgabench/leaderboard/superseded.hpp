// What lies in a board's superseded/: entries as they were before others took their place.
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include <lgabench/leaderboard/entry.hpp>

namespace lgabench::leaderboard {

/// Which cell of two entries of one identity is not the same in both, the first of them, as words; "" where all are:
/// the same place with the same test scenes. A key may be another, since it names the data of its time.
std::string other_cell(const Entry& there, const Entry& here);

/// A line for each directory of superseded/ that cannot be read as an entry, or that the entry of its id does not name;
/// for each that an entry names and that is not there; and for each whose cells are not that entry's.
std::vector<std::string> problems_of_superseded(const fs::path& board, const std::vector<Entry>& entries);

/// The entries of which the board has a successor since, and that lie in superseded/ as what_changed() allows: places,
/// relative to the board. `before`: bytes of the board's files. What lay in superseded/ must lie there unchanged, and
/// what is new there must be such an entry; else `problems` gets a line that names the revision.
std::set<std::string> superseded_since(const std::map<std::string, std::string>& before, const fs::path& board,
                                       const std::vector<Entry>& entries, const std::string& revision,
                                       std::vector<std::string>& problems);

}  // namespace lgabench::leaderboard
