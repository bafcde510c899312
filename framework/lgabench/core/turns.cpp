#include <lgabench/core/turns.hpp>

#include <algorithm>
#include <cstddef>
#include <set>
#include <tuple>
#include <utility>

#include <lgabench/core/contains.hpp>

namespace lgabench {
namespace {

using Parts = std::vector<Part> Turn::*;

const std::string& name_of(const Named& object, Part part) {
  return part == Part::object_type ? object.object_type : object.texture;
}

// Objects that no turn tells apart are of one kind, so that a search has few.
class Kinds {
 public:
  explicit Kinds(const std::vector<Turn>& turns) : turns_(turns) {}

  std::size_t of(const Named& object) {
    Kind kind;
    for (const Turn& turn : turns_) kind.in.push_back(any_contains(turn.sets, object.object_type, object.texture));
    for (const Part part : {Part::object_type, Part::texture})
      for (const Turn& turn : turns_)
        if (contains(turn.same, part) || contains(turn.different, part))
          (part == Part::object_type ? kind.name.object_type : kind.name.texture) = name_of(object, part);
    const auto known = std::find(all_.begin(), all_.end(), kind);
    if (known != all_.end()) return static_cast<std::size_t>(known - all_.begin());
    all_.push_back(std::move(kind));
    return all_.size() - 1;
  }

  std::size_t count() const { return all_.size(); }

  // Whether the turn may take one of the kind beside what it took.
  bool may_join(std::size_t turn, std::size_t kind, const std::vector<std::size_t>& taken) const {
    const auto alike = [&](std::size_t other, Part part) {
      return name_of(all_[kind].name, part) == name_of(all_[other].name, part);
    };
    const Turn& conditions = turns_[turn];
    return all_[kind].in[turn] && std::all_of(taken.begin(), taken.end(), [&](std::size_t other) {
             return std::all_of(conditions.same.begin(), conditions.same.end(),
                                [&](Part part) { return alike(other, part); }) &&
                    std::none_of(conditions.different.begin(), conditions.different.end(),
                                 [&](Part part) { return alike(other, part); });
           });
  }

 private:
  struct Kind {
    std::vector<bool> in;  // by turn
    Named name;            // without what no turn's conditions read
    bool operator==(const Kind& other) const { return in == other.in && name == other.name; }
  };
  const std::vector<Turn>& turns_;
  std::vector<Kind> all_;
};

// Shares what was brought out among the turns and, where more may be brought, what is left on the table.
class Sharing {
 public:
  Sharing(const std::vector<Turn>& turns, const std::vector<Named>& on_table, const std::vector<Named>& brought)
      : turns_(turns), kinds_(turns) {
    for (const Named& object : brought) brought_.push_back(kinds_.of(object));
    for (const Named& object : on_table) {
      if (is_place(object.object_type)) continue;
      const std::size_t kind = kinds_.of(object);
      left_.resize(kinds_.count());
      ++left_[kind];
    }
    left_.resize(kinds_.count());
  }

  bool is_fulfilled() { return fulfilled(false); }
  bool can_be_fulfilled() { return fulfilled(true); }
  bool can_be_fulfilled_with(const Named& next) {
    const std::size_t kind = kinds_.of(next);
    --left_[kind];
    brought_.push_back(kind);
    const bool can = can_be_fulfilled();
    brought_.pop_back();
    ++left_[kind];
    return can;
  }

 private:
  using Taken = std::vector<std::size_t>;

  bool fulfilled(bool may_bring) {
    may_bring_ = may_bring;
    failed_.clear();
    return fulfilled_from(0, 0, false);
  }

  // Whether the turns from this one on are fulfilled by what was brought from `at` on. `found`: by the turn before.
  bool fulfilled_from(std::size_t turn, std::size_t at, bool found) {
    if (turn == turns_.size()) return at == brought_.size();
    if (turns_[turn].only_if_nothing && found) return fulfilled_from(turn + 1, at, found);
    const auto state = std::tuple(turn, at, left_);
    if (failed_.count(state) != 0) return false;
    Taken taken;
    if (plays(turn, at, taken) || finds_nothing(turn, at)) return true;
    failed_.insert(state);
    return false;
  }

  // Whether the turn takes what was brought from `at` on, besides what it took, and the later turns are fulfilled.
  bool plays(std::size_t turn, std::size_t at, Taken& taken) {
    if (is_over(turn, at, taken) && fulfilled_from(turn + 1, at, !taken.empty())) return true;
    if (at == brought_.size()) return may_bring_ && brings(turn, 0, taken);
    if (!kinds_.may_join(turn, brought_[at], taken)) return false;
    taken.push_back(brought_[at]);
    return plays(turn, at + 1, taken);
  }

  // The same with one more of what is left on the table, of this kind or a later one: a turn's order is no matter.
  bool brings(std::size_t turn, std::size_t from, Taken& taken) {
    const std::size_t at = brought_.size();
    for (std::size_t kind = from; kind < left_.size(); ++kind) {
      if (left_[kind] == 0 || !kinds_.may_join(turn, kind, taken)) continue;
      taken.push_back(kind);
      --left_[kind];
      const bool fits = (is_over(turn, at, taken) && fulfilled_from(turn + 1, at, true)) || brings(turn, kind, taken);
      ++left_[kind];
      taken.pop_back();
      if (fits) return true;
    }
    return false;
  }

  bool is_over(std::size_t turn, std::size_t at, const Taken& taken) const {
    if (turns_[turn].take) return taken.size() == static_cast<std::size_t>(*turns_[turn].take);
    const auto joins = [&](std::size_t kind) { return kinds_.may_join(turn, kind, taken); };
    for (std::size_t kind = 0; kind < left_.size(); ++kind)
      if (left_[kind] > 0 && joins(kind)) return false;
    return std::none_of(brought_.begin() + static_cast<std::ptrdiff_t>(at), brought_.end(), joins);
  }

  // Whether fewer than the turn takes fit together, so that the next is played in its place.
  bool finds_nothing(std::size_t turn, std::size_t at) {
    if (!turns_[turn].take || turn + 1 == turns_.size() || !turns_[turn + 1].only_if_nothing) return false;
    std::vector<int> there = left_;
    for (std::size_t i = at; i < brought_.size(); ++i) ++there[brought_[i]];
    Taken none;
    return !fit(turn, 0, there, none) && fulfilled_from(turn + 1, at, false);
  }

  // Whether so many as the turn takes are there that fit together.
  bool fit(std::size_t turn, std::size_t from, std::vector<int>& there, Taken& taken) const {
    if (taken.size() == static_cast<std::size_t>(*turns_[turn].take)) return true;
    for (std::size_t kind = from; kind < there.size(); ++kind) {
      if (there[kind] == 0 || !kinds_.may_join(turn, kind, taken)) continue;
      taken.push_back(kind);
      --there[kind];
      const bool fits = fit(turn, kind, there, taken);
      ++there[kind];
      taken.pop_back();
      if (fits) return true;
    }
    return false;
  }

  const std::vector<Turn>& turns_;
  Kinds kinds_;
  std::vector<std::size_t> brought_;
  std::vector<int> left_;  // how many of each kind are on the table
  bool may_bring_ = false;
  std::set<std::tuple<std::size_t, std::size_t, std::vector<int>>> failed_;  // turn, at, left
};

std::vector<Turn> turns_of(const Meaning& meaning) {
  if (!meaning.turns.empty()) return meaning.turns;
  return {{meaning.sets, 1, {}, {}, false}};
}

}  // namespace

std::vector<Named> wanted(const Meaning& meaning, const std::vector<Named>& on_table,
                          const std::vector<Named>& brought) {
  const std::vector<Turn> turns = turns_of(meaning);
  Sharing sharing(turns, on_table, brought);
  std::vector<Named> some, asked;
  for (const Named& object : on_table) {
    if (is_place(object.object_type) || contains(asked, object)) continue;
    asked.push_back(object);
    if (meaning.belongs(object.object_type, object.texture) && sharing.can_be_fulfilled_with(object))
      some.push_back(object);
  }
  return some;
}

bool is_done(const Meaning& meaning, const std::vector<Named>& on_table, const std::vector<Named>& brought) {
  const std::vector<Turn> turns = turns_of(meaning);
  Sharing sharing(turns, on_table, brought);
  return sharing.is_fulfilled() || (brought.empty() && !sharing.can_be_fulfilled());
}

int takes_left(const Meaning& meaning, std::vector<Named> on_table, std::vector<Named> brought) {
  int takes = 0;
  while (!is_done(meaning, on_table, brought)) {
    const std::vector<Named> next = wanted(meaning, on_table, brought);
    if (next.empty()) break;
    on_table.erase(std::find(on_table.begin(), on_table.end(), next.front()));
    brought.push_back(next.front());
    ++takes;
  }
  return takes;
}

}  // namespace lgabench
