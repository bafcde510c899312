#include <lgabench/harness/schedule.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <numeric>
#include <tuple>

#include <lgabench/core/random.hpp>

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

Schedule::Schedule(const std::vector<const Cell*>& cells, std::optional<std::uint32_t> drawn_by, Costs learnt)
    : drawn_(drawn_by.has_value()), costs_(std::move(learnt)) {
  std::map<std::string, std::size_t> known;
  std::vector<int> places(cells.size());
  std::iota(places.begin(), places.end(), 0);
  if (drawn_by) places = RandomStream(fmt::format("order/{}", *drawn_by)).permutation(static_cast<int>(cells.size()));
  auto place = places.begin();
  for (const Cell* cell : cells) {
    const auto [row, is_new] = known.emplace(cell->method.name, rows_.size());
    if (is_new) rows_.push_back({cell->method.name, {}, 0});
    Row& all = rows_[row->second];
    all.left.push_back({cell, usual_seconds(*cell), static_cast<std::size_t>(*place++)});
    all.usual_s += all.left.back().usual_s;
  }
  for (Row& row : rows_)
    std::sort(row.left.begin(), row.left.end(), [this](const Waiting& a, const Waiting& b) {
      return std::pair(drawn_ ? 0. : a.usual_s, b.place) < std::pair(drawn_ ? 0. : b.usual_s, a.place);
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
    return std::tuple(!drawn_ && !costs_.knows(row.name), drawn_ ? 0. : costs_.expected_seconds(row.name, one.usual_s),
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
