#include <tabletop/errand_tables.hpp>

#include <algorithm>
#include <iterator>
#include <set>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/sampling.hpp>
#include <lgabench/core/turns.hpp>

namespace lgabench::tabletop {

void Pool::add(const std::string& type, const std::string& texture) {
  if (types_.empty() || types_.back() != type) {
    types_.push_back(type);
    textures_.emplace_back();
  }
  textures_.back().push_back(texture);
}

bool Pool::holds(const Named& one) const {
  const auto found = std::find(types_.begin(), types_.end(), one.object_type);
  return found != types_.end() && contains(textures_[static_cast<std::size_t>(found - types_.begin())], one.texture);
}

Named Pool::draw(RandomStream& random) const {
  const auto type = random.below(static_cast<std::uint32_t>(types_.size()));
  return {types_[type], any_of(textures_[type], random)};
}

Named Pool::draw_like(const Named& other, RandomStream& random) const {
  std::vector<std::size_t> like;
  const bool by_type = random.coin();
  for (std::size_t i = 0; i < types_.size(); ++i)
    if (by_type ? types_[i] == other.object_type : contains(textures_[i], other.texture)) like.push_back(i);
  if (like.empty()) return draw(random);
  const std::size_t type = like[random.below(static_cast<std::uint32_t>(like.size()))];
  return {types_[type], by_type ? any_of(textures_[type], random) : other.texture};
}

namespace {

constexpr std::pair<int, int> training_members{2, 3};

const Named& one_of(const std::vector<Named>& things, RandomStream& random) {
  return things[random.below(static_cast<std::uint32_t>(things.size()))];
}

int between(std::pair<int, int> fewest_and_most, RandomStream& random) {
  const auto [fewest, most] = fewest_and_most;
  return fewest + static_cast<int>(random.below(static_cast<std::uint32_t>(most - fewest + 1)));
}

// Half of them share the type or the texture of one before, so that some kind is there twice.
Named draw_member(const ErrandClass& of, const std::vector<Named>& before, RandomStream& random) {
  const Pool& pool = of.members[random.below(static_cast<std::uint32_t>(of.members.size()))];
  std::vector<Named> alike;
  std::copy_if(before.begin(), before.end(), std::back_inserter(alike), [&](const Named& o) { return pool.holds(o); });
  if (alike.empty() || random.coin()) return pool.draw(random);
  const Named other = one_of(alike, random);
  return pool.draw_like(other, random);
}

Named draw_near_miss(const ErrandClass& of, const std::vector<Named>& members, RandomStream& random) {
  if (members.empty()) return of.near.draw(random);
  const Named other = one_of(members, random);
  return of.near.draw_like(other, random);
}

// Near misses, of what belongs if anything does, and what other commands mean, in turn; the first by a coin.
void add_others(const ErrandClass& of, const std::vector<Named>& belong, int count, std::vector<Named>& things,
                RandomStream& random) {
  bool near = random.coin();
  for (int i = 0; i < count; ++i, near = !near)
    things.push_back(near ? draw_near_miss(of, belong, random)
                          : of.others[random.below(static_cast<std::uint32_t>(of.others.size()))].draw(random));
}

// Members one by one, then others.
Things draw_table(const ErrandClass& of, int members, int count, RandomStream& random) {
  Things table;
  while (static_cast<int>(table.things.size()) < members) table.things.push_back(draw_member(of, table.things, random));
  add_others(of, std::vector<Named>(table.things), count - members, table.things, random);
  return table;
}

// Names of what is taken, in order.
using Sequence = std::vector<std::pair<std::string, std::string>>;
using Sequences = std::set<Sequence>;

Sequence sequence_of(const std::vector<Named>& brought) {
  Sequence names;
  for (const Named& one : brought) names.emplace_back(one.object_type, one.texture);
  return names;
}

// All right ones; false where a wanted take leads nowhere, or one is of another number of takes.
bool find_right(const Meaning& meaning, const Things& table, std::optional<int> takes, std::vector<Named>& brought,
                Sequences& right) {
  constexpr std::size_t most = 5;
  if (is_done(meaning, table.things, brought)) {
    right.insert(sequence_of(brought));
    return !takes || static_cast<int>(brought.size()) == *takes;
  }
  const std::vector<Named> next = wanted(meaning, table.things, brought);
  if (next.empty() || brought.size() == static_cast<std::size_t>(takes.value_or(most))) return false;
  for (const Named& one : next) {
    Things left{table.things, {}};
    left.things.erase(std::find(left.things.begin(), left.things.end(), one));
    if (table.later) left.things.push_back(*table.later);
    brought.push_back(one);
    const bool leads = find_right(meaning, left, takes, brought, right);
    brought.pop_back();
    if (!leads) return false;
  }
  return true;
}

std::optional<Sequences> right_sequences(const Meaning& meaning, const Things& table,
                                         std::optional<int> takes = std::nullopt) {
  Sequences right;
  std::vector<Named> brought;
  if (!find_right(meaning, table, takes, brought, right)) return std::nullopt;
  return right;
}

Sequence in_order_of_names(Sequence names) {
  std::sort(names.begin(), names.end());
  return names;
}

// Whether taking all that is wanted at first is right, in some order.
bool right_at_first(const Meaning& meaning, const std::vector<Named>& things, const Sequences& right) {
  const std::vector<Named> names = wanted(meaning, things, {});
  std::vector<Named> first;
  std::copy_if(things.begin(), things.end(), std::back_inserter(first),
               [&names](const Named& one) { return contains(names, one); });
  const Sequence all = in_order_of_names(sequence_of(first));
  return std::any_of(right.begin(), right.end(), [&all](const Sequence& one) { return in_order_of_names(one) == all; });
}

// The draw tells the pair's commands apart, and each needs so many takes of what stands there.
bool is_kept(const std::vector<Meaning>& pair, const Things& table, std::pair<int, int> needed) {
  std::vector<Sequences> right;
  for (std::size_t i = 0; i < pair.size(); ++i) {
    const Meaning& meaning = pair[i];
    auto found = right_sequences(meaning, {table.things, {}}, i == 0 ? needed.first : needed.second);
    if (found && table.later) found = right_sequences(meaning, table);
    if (!found) return false;
    right.push_back(std::move(*found));
  }
  const auto in_both = [&right](const Sequence& one) { return right[1].count(one) > 0; };
  if (std::any_of(right[0].begin(), right[0].end(), in_both)) return false;
  return !right_at_first(pair[0], table.things, right[0]) || !right_at_first(pair[1], table.things, right[1]);
}

bool shows_takes(const Meaning& meaning, const Things& table) {
  const auto right = right_sequences(meaning, table);
  return right && right->count({}) == 0;
}

}  // namespace

std::optional<Things> draw_test(const ErrandClass& of, const std::vector<Meaning>& pair, std::pair<int, int> needed,
                                bool appears, RandomStream& random) {
  const int members = between(of.belong, random);
  Things table = draw_table(of, members, test_things, random);
  const std::vector<Named> belong(table.things.begin(), table.things.begin() + members);
  if (appears) table.later = random.coin() ? draw_member(of, belong, random) : draw_near_miss(of, belong, random);
  if (!is_kept(pair, table, needed)) return std::nullopt;
  return table;
}

std::optional<Things> draw_training(const ErrandClass& of, const Meaning& meaning, RandomStream& random) {
  Things table = draw_table(of, between(training_members, random), training_things, random);
  if (!shows_takes(meaning, table)) return std::nullopt;
  return table;
}

Things draw_to_refuse(const ErrandClass& of, int count, RandomStream& random) {
  Things table;
  table.meant = draw_member(of, {}, random);
  add_others(of, {}, count, table.things, random);
  return table;
}

}  // namespace lgabench::tabletop
