// The grammar: how phrases make a command of a family, and what it then means.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/meaning.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/drawn/lexicon.hpp>

namespace lgabench::drawn {

/// A command with what it means, as scenarios have it.
struct DrawnCommand {
  std::string id, family, utterance;
  Meaning meaning;
  std::vector<FeatureSet> undecided, near_misses;
  std::vector<std::string> why;  // of each entry of the lexicon, in the order of the words
};

/// The families of commands, in the order in which a draw goes through them: lookup, category, colour, negation, union,
/// relation, superlative, compound.
const std::vector<std::string>& families();

/// What a compound command is made of: descriptions of the lexicon, and the rule for which of several is meant.
inline constexpr int fewest_parts = 3, most_parts = 5;

/// A command of the family, without an id; nothing where many draws make none in which every part counts.
std::optional<DrawnCommand> make_command(const Lexicon& lexicon, const std::string& family, int parts,
                                         RandomStream& random);

}  // namespace lgabench::drawn
