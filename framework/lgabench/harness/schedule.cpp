#include <lgabench/harness/schedule.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
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
  std::map<std::string, std::size_t> known;
  std::size_t place = 0;
  for (const Cell* cell : cells) {
    const auto [row, is_new] = known.emplace(cell->method.name, rows_.size());
    if (is_new) rows_.push_back({cell->method.name, {}, 0});
    Row& all = rows_[row->second];
    all.left.push_back({cell, usual_seconds(*cell), place++});
    all.usual_s += all.left.back().usual_s;
  }
  for (Row& row : rows_)
    std::sort(row.left.begin(), row.left.end(), [](const Waiting& a, const Waiting& b) {
      return std::pair(a.usual_s, b.place) < std::pair(b.usual_s, a.place);
    });
}

double Schedule::left_s() const {
  return std::accumulate(rows_.begin(), rows_.end(), 0., [this](double sum, const Row& row) {
    return sum + costs_.expected_seconds(row.name, row.usual_s);
  });
}

const Cell* Schedule::next() {
  const auto urgency = [this](const Row& row) {
    const Waiting& one = row.left.back();
    return std::tuple(!costs_.knows(row.name), costs_.expected_seconds(row.name, one.usual_s),
                      -static_cast<double>(one.place));
  };
  const auto longest =
      std::max_element(rows_.begin(), rows_.end(), [&](const Row& a, const Row& b) { return urgency(a) < urgency(b); });
  const Waiting given = longest->left.back();
  longest->left.pop_back();
  longest->usual_s -= given.usual_s;
  if (longest->left.empty()) rows_.erase(longest);
  return given.cell;
}

}  // namespace lgabench
