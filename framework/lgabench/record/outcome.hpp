// How an episode ended, as letters: in a report's page and in entries of the leaderboard.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/record/episode.hpp>

namespace lgabench {

/// An episode's failure and attribution, as in Episode.
struct Outcome {
  Failure failure = failure::none;
  std::string attribution{};
};

constexpr std::size_t most_failure_words = 26;  // a letter for each

/// "." for success, else from 'a' on as failures stand in `words`; and what it is attributed to: 'a'bstraction,
/// 'p'olicy, perception ('s'een otherwise), "." where nobody says. @pre the failure is one of the words
char outcome_letter(const Episode& episode, const std::vector<std::string>& words);
char attribution_letter(const Episode& episode);
/// What the two letters say; none for letters that say nothing.
std::optional<Outcome> read_outcome(char letter, char attribution, const std::vector<std::string>& words);

/// One letter for both, in an entry: the outcome's, a capital where the failure is attributed to the abstraction.
char entry_letter(const Episode& episode, const std::vector<std::string>& words);
/// What the letter says: no attribution where it is small. None for a letter that says nothing.
std::optional<Outcome> read_entry_letter(char letter, const std::vector<std::string>& words);
/// The letter of a cell that its method failed, in place of each episode's.
constexpr char failed_cell_letter = '!';

/// Whether a letter, of the one kind or the other, says success; how many of them do.
bool is_success(char letter);
int successes(const std::string& letters);

}  // namespace lgabench
