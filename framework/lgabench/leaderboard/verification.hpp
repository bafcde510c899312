// Lines of verifications.jsonl: what they say, and what it comes to.
#pragma once
#include <string>
#include <vector>

#include <lgabench/leaderboard/entry.hpp>
#include <lgabench/report/agreement.hpp>

namespace lgabench::leaderboard {

/// A line as docs/formats has it: its cells are those that its nonce chooses, and its counts contradict neither each
/// other nor the entry nor `passed`. @throws InputError with the place
void expect_verification(const JsonReader& line, const Entry& entry);

/// A replay's verdict, from its counts: "agrees" on another processor than the entry's first alone.
/// @pre expect_verification()
report::Reproduction replay_verdict(const Entry& entry, const Json& line);

/// What somebody's lines say that are not vouched for, each claim once: "claimed by B. Reader: replayed".
std::vector<std::string> claims(const Entry& entry);

}  // namespace lgabench::leaderboard
