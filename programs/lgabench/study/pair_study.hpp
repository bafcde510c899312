// The study of disputed pairs: what it asks, how many people it needs, what they settle.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/study/protocol.hpp>

namespace lgabench::study {

/// The set of a protocol: every command with disputed pairs (abstraction/disputed.hpp), of each row of them up to four,
/// in which types and textures vary as far as they can, and two controls that the truth settles, one of them meant.
/// Drawn from the seed. @throws InputError where a command is no scenario's.
Json disputed_items(std::uint64_t seed);

/// How many pairs a study has.
struct PairCount {
  int disputed = 0, controls = 0;
};
PairCount count_pairs(const Protocol& protocol);

/// What people said of one pair: yes, no, can't tell.
using Said = std::array<int, 3>;

/// Two-sided p of the exact binomial test that no answer has more than half of all; 1 where none has. Who cannot tell
/// stands against both others. @pre somebody answered
double p_unsettled(const Said& said);

/// The chance that `people` settle a pair which each of them calls meant with probability `share`: p_unsettled() of
/// `pairs` of them adjusted by Holm, in his first step, so that it is at least this. @pre both > 0
double power(int people, int pairs, double share = .8);
/// The fewest people from which on power() is at least .8.
int people_needed(int pairs);

/// What the protocol asks, how many people it needs, and how precise a share of as many as planned is.
std::string power_words(const Protocol& protocol);

/// Krippendorff's alpha for nominal values and any number of observers a unit; of each unit how often it got each value
/// (Krippendorff 2011, Computing Krippendorff's alpha-reliability, C and D). None where all values are one.
std::optional<double> krippendorff_alpha(const std::vector<std::vector<int>>& units);

}  // namespace lgabench::study
