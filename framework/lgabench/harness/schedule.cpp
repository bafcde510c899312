#include <lgabench/harness/schedule.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numeric>
#include <tuple>

namespace lgabench {

Shard read_shard(const std::string& text) {
  Shard shard;
  const char *const begin = text.data(), *const end = begin + text.size();
  const auto index = std::from_chars(begin, end, shard.index);
  const bool slash = index.ec == std::errc() && index.ptr != end && *index.ptr == '/';
  const auto count = slash ? std::from_chars(index.ptr + 1, end, shard.count) : index;
  if (!slash || count.ec != std::errc() || count.ptr != end || shard.index < 1 || shard.index > shard.count)
    throw InputError(fmt::format("--shard {}: expected i/n with i from 1 to n, such as 1/2", text));
  return shard;
}

std::vector<const Cell*> cells_of(const std::vector<Cell>& cells, Shard shard) {
  std::vector<const Cell*> deck, dealt;
  for (const Cell& cell : cells) deck.push_back(&cell);
  const auto kind = [](const Cell* c) { return std::tie(c->method.kind, c->method.name, c->demonstrations); };
  std::stable_sort(deck.begin(), deck.end(), [&](const Cell* a, const Cell* b) { return kind(a) < kind(b); });
  for (auto i = static_cast<std::size_t>(shard.index - 1); i < deck.size(); i += static_cast<std::size_t>(shard.count))
    dealt.push_back(deck[i]);
  return dealt;
}

Schedule::Schedule(const std::vector<const Cell*>& cells) {
  for (const Cell* cell : cells) left_.push_back({cell, usual_seconds(*cell)});
}

double Schedule::left_s() const {
  return std::accumulate(left_.begin(), left_.end(), 0.,
                         [this](double sum, const Waiting& one) { return sum + expected_s(one); });
}

const Cell* Schedule::next() {
  const auto urgency = [this](const Waiting& one) {
    return std::pair(!costs_.knows(one.cell->method.name), expected_s(one));
  };
  const auto longest = std::max_element(left_.begin(), left_.end(),
                                        [&](const Waiting& a, const Waiting& b) { return urgency(a) < urgency(b); });
  const Cell* cell = longest->cell;
  left_.erase(longest);
  return cell;
}

}  // namespace lgabench
