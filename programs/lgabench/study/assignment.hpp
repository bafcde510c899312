// Assigns to each person what they are asked, and when: a pure function of the protocol's seed and the person's number.
#pragma once
#include <array>
#include <vector>

#include <lgabench/study/protocol.hpp>

namespace lgabench::study {

/// What one person is asked, and in which order. A slot is a person's number in the order of consent, from 0; it is
/// never given twice.
struct Assignment {
  std::array<Condition, 2> conditions{};  // of the first period, of the second
  std::array<int, 2> sets{};              // asked in each period: 0, 0 with one set
  std::array<std::vector<int>, 2> order;  // of each period's set, as indices
};

/// One set: blocks of 2 over the order of conditions. Two sets: blocks of 4 over that order × which set comes first;
/// the rows of a Williams square within each set, all of them once in as many blocks. Both from the seed. Of pairs: one
/// period, every person in an order of their own.
Assignment assign(const Protocol& protocol, int slot);

/// A Williams square of an even order n (Williams 1949): every row an order of 0..n-1; each number occurs once in each
/// column, and right after each other one once.
std::vector<std::vector<int>> williams_square(int n);

Json to_json(const Assignment& assignment);

}  // namespace lgabench::study
