// Commands that nobody knew: whether a method reads a command, or has learned the published ones' truths by heart.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/leaderboard/recompute.hpp>

namespace lgabench::leaderboard {

constexpr int fewest_commands = 20;                           // of which five points are one command
constexpr int most_commands = 1000, most_published = 100000;  // a stranger's line is read in no time

/// Why no command tests the entry's method: "selects nothing", "selects from demonstrations", "asks people", or that it
/// is a reference; "" where one does.
std::string why_exempt(const Entry& entry);

/// Whether so few drawn commands have an exact Selection by chance. A method is as good there as it was if it is exact
/// in 95 % of those where `lga` is, on the truth as the answers to both; or if it is no less often exact than in the
/// published commands (Fisher's exact test, one-sided, p > .05). `lines`: of kind commands, put together.
bool knows_fresh_commands(const std::vector<const Json*>& lines);

/// A line's counts. @throws InputError with the place, also where they contradict `passed`.
void expect_fresh_commands(const JsonReader& line);

/// "39 of 40 drawn commands exact (lga: 40), 14 of 14 published"
std::string fresh_commands_words(const Json& line);

/// A line of kind commands, without who made it, and the run that it is of. Draws commands of the shipped lexicon, in
/// household, whose meaning is one product; the answers are that product, flat and structured. Scores select() of the
/// entry's method and of `lga`, without a policy. None where it was interrupted.
/// @throws InputError for an entry that is exempt, or has persons in place of commands; for fewer commands than can
/// tell a table of the published ones from a method; and as verification().
struct OnFreshCommands {
  Json line;
  RunRecord run;
};
std::optional<OnFreshCommands> on_fresh_commands(const Entry& entry, const Installed& installed,
                                                 const std::string& nonce, const Catalogue& catalogue,
                                                 const VerifyOptions& options);

}  // namespace lgabench::leaderboard
