// /phi of entry.json says each value once: numbers stand for values of /said.
#pragma once
#include <cstdint>
#include <string>

#include <lgabench/core/json.hpp>

namespace lgabench::leaderboard {

/// Bytes of entry.json, of which the largest in its long form has 1.3 million; and of all values that numbers in a /phi
/// stand for: the most of an entry is 15 million, a rule of labels with a Selection of many pairs for each of 12
/// commands.
constexpr std::uintmax_t most_entry_bytes = 4 << 20, most_said_bytes = 24 << 20;

/// entry.json in its short form: commands of /phi, their Selections and qualities, and lists of names in Selections go
/// to /said, once each. An entry without Selections stays as it is.
Json shortened(Json entry);

/// The long form of entry.json, which Entry and hashes have; an entry without /said is in that form already. @throws
/// InputError for a number that stands for nothing, and where the long form would have more than most_said_bytes.
/// `file`: its name
Json expanded(Json entry, const std::string& file);

/// The file's text, of either form: /said last, each value in a line of its own.
std::string text_of_entry(Json entry);

}  // namespace lgabench::leaderboard
