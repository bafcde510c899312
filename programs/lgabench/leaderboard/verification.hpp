// Lines of verifications.jsonl: what they say, and what it comes to.
#pragma once
#include <string>
#include <vector>

#include <lgabench/leaderboard/entry.hpp>
#include <lgabench/statistics/agreement.hpp>

namespace lgabench::leaderboard {

/// @throws InputError for what is no date, as 2026-01-31.
void expect_date(const JsonReader& reader);

/// A line as docs/formats has it: its cells are those that its nonce chooses, and its counts contradict neither each
/// other nor the entry nor `passed`. `hash`: the entry's. @throws InputError with the place
void expect_verification(const JsonReader& line, const Entry& entry, const std::string& hash);

/// The processor that a line names. @pre expect_verification()
Processor processor_of(const Json& line);

/// A replay's verdict, from its counts: "agrees" on another kind of processor than the entry's first alone. This is the
/// milder rule, since a reader need not have the method: verification() also demands the same bits on two kinds, where
/// a method owes them. @pre expect_verification()
statistics::Reproduction replay_verdict(const Entry& entry, const Json& line);

/// Success on other test scenes minus that on the board's, with its 95 % interval.
struct FreshEstimate {
  std::string arm;  // "": the mean over arms, as the score has it
  double difference = 0, low = 0, high = 0;
  double p_holm = 1;  // two-sided, Holm's over the estimates

  bool differs() const { return p_holm <= .05; }
};
/// One estimate for each arm, and, where there are several, one for their mean: of all fresh scenes of these lines put
/// together, each cell's beside the board's of the same policy. No number of lines dilutes what is true of most scenes.
/// The variance is that of Agresti and Caffo (2000): of each share, a success and a failure are added.
/// @pre lines of kind fresh with /successes
std::vector<FreshEstimate> fresh_estimates(const Entry& entry, const std::vector<const Json*>& lines);

/// The smallest loss on other scenes, of the mean over arms, that a line finds in four of five draws (two-sided, p .05,
/// the strictest of Holm's steps): what "agrees" leaves open.
double smallest_found(const std::vector<FreshEstimate>& estimates);

/// The cells that a nonce chooses to be played on other scenes: one number of demonstrations and one training seed, in
/// every scenario and layout.
std::vector<std::size_t> fresh_cells(const Entry& entry, const std::string& nonce);

/// What somebody's lines say that are not vouched for, each claim once: "claimed by B. Reader: replayed".
std::vector<std::string> claims(const Entry& entry);

}  // namespace lgabench::leaderboard
