#include <lgabench/study/assignment.hpp>

#include <fmt/format.h>

#include <numeric>

#include <lgabench/core/random.hpp>

namespace lgabench::study {

std::vector<std::vector<int>> williams_square(int n) {
  std::vector<std::vector<int>> rows;
  for (int row = 0; row < n; ++row) {
    std::vector<int> order;
    for (int column = 0; column < n; ++column)  // 0, 1, n-1, 2, n-2, ... turned by the row
      order.push_back(((column % 2 == 1 ? (column + 1) / 2 : n - column / 2) + row) % n);
    rows.push_back(order);
  }
  return rows;
}

Assignment assign(const Protocol& protocol, int slot) {
  const int size = protocol.crossover() ? 4 : 2, block = slot / size;
  const auto stream = [&protocol](const std::string& what, int number) {
    return RandomStream(fmt::format("study/{}/{}/{}", protocol.seed, what, number));
  };
  if (protocol.of_pairs()) {
    Assignment once;
    once.order[0] = stream("order", slot).permutation(static_cast<int>(protocol.sets[0].size()));
    return once;
  }
  const int cell = stream("block", block).permutation(size)[static_cast<std::size_t>(slot % size)];
  Assignment assignment;
  assignment.conditions = {Condition::human, Condition::lga_hill};
  if (cell % 2 == 1) std::swap(assignment.conditions[0], assignment.conditions[1]);
  if (!protocol.crossover()) {
    std::vector<int> fixed(protocol.sets[0].size());
    std::iota(fixed.begin(), fixed.end(), 0);
    assignment.order = {fixed, fixed};
    return assignment;
  }
  assignment.sets = {cell / 2, 1 - cell / 2};
  const int n = static_cast<int>(protocol.sets[0].size());
  const auto square = williams_square(n);
  for (std::size_t period = 0; period < 2; ++period) {
    // Each combination of the block meets every row once in n blocks.
    const int turn =
        stream(fmt::format("rows/{}/{}", cell, period), block / n).permutation(n)[static_cast<std::size_t>(block % n)];
    assignment.order[period] = square[static_cast<std::size_t>(turn)];
  }
  return assignment;
}

Json to_json(const Assignment& assignment) {
  Json json{{"conditions", Json::array()}, {"sets", assignment.sets}, {"order", assignment.order}};
  for (const Condition condition : assignment.conditions) json["conditions"].push_back(to_string(condition));
  return json;
}

}  // namespace lgabench::study
