// What decides on an entry's place beside its success: which rankings it is in, why it has no rank, its marks. Who adds
// a property of entries that decides adds it here, or in conditions.hpp where a row may be played with it or without.
#pragma once
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/leaderboard/entry.hpp>
#include <lgabench/leaderboard/tracks.hpp>

namespace lgabench::leaderboard {

/// Whether the ranking has the entry among its rows, ranked or not.
bool is_in(const Entry& entry, Ranking ranking);

/// Why the entry has no rank in a table of that track: "" where it has one.
std::string why_not_ranked(const Entry& entry, const Track& track = {});

/// What pages say of the entry beside its tier and why it has no rank. `is_ranked`: where it has one.
std::vector<std::string> marks_of(const Entry& entry, bool is_ranked);

/// Reasons and marks that need an explanation, and that, as the board's pages list them.
std::vector<std::pair<std::string, std::string>> meanings_of_marks();

/// The mark of an entry whose answers are a file that its authors wrote, which may be a copy of the truth.
inline constexpr const char* as_submitted = "answers as submitted";

/// Marks of a row that was tried on the board's scenes alone, and on its commands alone.
inline constexpr const char* never_fresh = "never on fresh scenes";
inline constexpr const char* never_fresh_commands = "never on fresh commands";

/// Where its Selections come from.
std::set<std::string> provenances_of(const Entry& entry);

/// The option of that name, of the method that acts: "regression" is the paper's network; "" where a method or a
/// reference row has none.
std::string policy_of(const Entry& entry);

}  // namespace lgabench::leaderboard
