// What the board's maintainers say of entries. vouched.json and vouched_entries.json: the lines that they answer for,
// and what these entries say beside their cells; other lines are claims. instructions.json: the vector instructions of
// processors whose records do not name them.
#pragma once
#include <map>
#include <set>
#include <string>

#include <lgabench/core/json.hpp>

namespace lgabench::leaderboard {

struct Entry;

struct Vouched {
  // What counts: both by their entry's hash.
  std::map<std::string, std::set<std::string>> lines;  // SHA-256 of lines (of verifications.jsonl, or /withdrawn of
                                                       // entry.json, as canonical JSON)
  std::map<std::string, std::string> entries;          // Entry::rest_hash()
  std::map<std::string, std::string> instructions;     // inferred ones, by their entry's id
};

inline constexpr const char* vouched_file = "vouched.json";
inline constexpr const char* vouched_entries_file = "vouched_entries.json";
inline constexpr const char* instructions_file = "instructions.json";

std::string line_hash(const Json& line);

/// These files of a board; nothing where there is none. @throws InputError with file and place
Vouched read_vouched(const fs::path& board);

/// Forgets all that was said of an entry: another takes its place.
void forget(const fs::path& board, const Entry& entry);

/// How many cells a replay of the entry must have played for somebody to vouch for it.
std::size_t enough_cells_of(const Entry& entry);

/// Adds a line of the entry, by its number in verifications.jsonl, or "withdrawn", and the hash of what else the entry
/// says. Returns the line. @throws InputError for a line that is not there or was vouched for, for an entry that is
/// another than when a line of it was vouched for, for a replay of fewer cells than 30 or all, and for one on fresh
/// scenes that does not tell its arms apart.
Json vouch(const fs::path& board, const std::string& entry, const std::string& line);

}  // namespace lgabench::leaderboard
