// vouched.json: the lines of entries that the board's maintainers answer for. Others are claims.
#pragma once
#include <map>
#include <set>
#include <string>

#include <lgabench/core/json.hpp>

namespace lgabench::leaderboard {

struct Entry;

/// SHA-256 of lines (of verifications.jsonl, or /withdrawn of entry.json, as canonical JSON), by their entry's hash.
using Vouched = std::map<std::string, std::set<std::string>>;

inline constexpr const char* vouched_file = "vouched.json";

std::string line_hash(const Json& line);

/// vouched.json of a board; nothing where there is none. @throws InputError with file and place
Vouched read_vouched(const fs::path& board);

/// Adds a line of the entry, by its number in verifications.jsonl, or "withdrawn". Returns its hash.
/// @throws InputError for a line that is not there or was vouched for, for a replay of fewer cells than 30 or all,
/// and for one on fresh scenes that does not tell its arms apart.
std::string vouch(const fs::path& board, const std::string& entry, const std::string& line);

}  // namespace lgabench::leaderboard
