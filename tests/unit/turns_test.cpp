// What may be brought next and when all is done, against a table of cases and against a definition that tries every
// order.
#include <lgabench/core/turns.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <set>
#include <sstream>
#include <utility>

#include <lgabench/core/files.hpp>
#include <lgabench/core/json.hpp>

namespace lgabench {

bool operator<(const Named& a, const Named& b) {
  return std::pair(a.object_type, a.texture) < std::pair(b.object_type, b.texture);
}

namespace {

using Things = std::vector<Named>;

// "red apple, blue pear"
Things things(const std::string& words) {
  std::istringstream all(words);
  Things some;
  for (std::string texture, type; all >> texture >> type;) some.push_back({type.substr(0, type.find(',')), texture});
  return some;
}

Things listed(const Json& names) {
  Things some;
  for (const Json& one : names) some.push_back({one.at(0), one.at(1)});
  return some;
}

const std::vector<std::string> colours{"blue", "red", "yellow"};
const FeatureSet apples{{"apple"}, colours}, fruit{{"apple", "lemon", "pear"}, colours};

std::set<Named> names_of(const Things& some) { return {some.begin(), some.end()}; }

TEST(Turns, SayWhatIsWantedAndWhenAllIsDone) {
  const Json golden = read_json(std::filesystem::path(LGABENCH_GOLDEN) / "turns.json");
  ASSERT_GE(golden.at("cases").size(), 33u);
  for (const Json& one : golden.at("cases")) {
    const Json turns{{"turns", one.at("turns")}};
    const Meaning meaning = read_unchecked_meaning(JsonReader(turns, "turns.json"));
    const Things on_table = listed(one.at("on_table")), brought = listed(one.at("brought"));
    EXPECT_EQ(wanted(meaning, on_table, brought), listed(one.at("wanted"))) << one.at("name");
    EXPECT_EQ(is_done(meaning, on_table, brought), one.at("done").get<bool>()) << one.at("name");
  }
}

TEST(Turns, NameEachWantedThingOnceInTheOrderOfTheTable) {
  const Things given = wanted(in_turns({{{fruit}, std::nullopt, {}, {}, false}}),
                              things("red pear, blue apple, red pear, red bowl"), {});
  EXPECT_EQ(given, things("red pear, blue apple"));
}

TEST(Turns, OfAMeaningWithoutAreOneOfItsThings) {
  const Meaning flat(apples);
  EXPECT_EQ(wanted(flat, things("red apple, blue apple, red bowl"), {}), things("red apple, blue apple"));
  EXPECT_TRUE(is_done(flat, things("red bowl"), {}));
  EXPECT_FALSE(is_done(flat, things("red apple"), {}));
  EXPECT_TRUE(is_done(flat, things("red apple"), things("blue apple")));
  EXPECT_TRUE(wanted(flat, things("red apple"), things("blue apple")).empty());
}

// The definition, slowly: all orders in which some of the things, or all, fulfil the turns.

bool may_be_together(const Turn& turn, const Things& some) {
  for (std::size_t i = 0; i < some.size(); ++i) {
    bool belongs = false;
    for (const FeatureSet& set : turn.sets) belongs = belongs || set.contains(some[i].object_type, some[i].texture);
    if (!belongs) return false;
    for (std::size_t k = 0; k < i; ++k)
      for (const Part part : {Part::object_type, Part::texture}) {
        const bool alike =
            part == Part::texture ? some[i].texture == some[k].texture : some[i].object_type == some[k].object_type;
        if (std::count(turn.same.begin(), turn.same.end(), part) > 0 && !alike) return false;
        if (std::count(turn.different.begin(), turn.different.end(), part) > 0 && alike) return false;
      }
  }
  return true;
}

bool some_fit(const Turn& turn, const Things& there) {
  for (unsigned chosen = 0; chosen < 1u << there.size(); ++chosen) {
    Things some;
    for (std::size_t i = 0; i < there.size(); ++i)
      if ((chosen >> i & 1u) != 0) some.push_back(there[i]);
    if (some.size() == static_cast<std::size_t>(*turn.take) && may_be_together(turn, some)) return true;
  }
  return false;
}

// `takes`: how many of the sequence each turn took.
bool is_right(const std::vector<Turn>& turns, const std::vector<std::size_t>& takes, const Things& sequence,
              const Things& left) {
  std::size_t at = 0;
  bool found = false;
  for (std::size_t t = 0; t < turns.size(); ++t) {
    const Turn& turn = turns[t];
    if (turn.only_if_nothing && found) {
      if (takes[t] > 0) return false;
      continue;
    }
    const auto first = sequence.begin() + static_cast<std::ptrdiff_t>(at);
    const Things took(first, first + static_cast<std::ptrdiff_t>(takes[t]));
    Things rest(first + static_cast<std::ptrdiff_t>(takes[t]), sequence.end());
    rest.insert(rest.end(), left.begin(), left.end());
    if (!may_be_together(turn, took)) return false;
    if (!turn.take) {
      for (const Named& other : rest) {
        Things more = took;
        more.push_back(other);
        if (may_be_together(turn, more)) return false;
      }
    } else if (takes[t] != static_cast<std::size_t>(*turn.take)) {
      if (takes[t] > 0 || t + 1 == turns.size() || !turns[t + 1].only_if_nothing || some_fit(turn, rest)) return false;
    }
    found = takes[t] > 0;
    at += takes[t];
  }
  return at == sequence.size();
}

bool is_right(const std::vector<Turn>& turns, std::vector<std::size_t>& takes, std::size_t in_all,
              const Things& sequence, const Things& left) {
  if (takes.size() == turns.size()) return is_right(turns, takes, sequence, left);
  for (std::size_t n = 0; n + in_all <= sequence.size(); ++n) {
    takes.push_back(n);
    const bool right = is_right(turns, takes, in_all + n, sequence, left);
    takes.pop_back();
    if (right) return true;
  }
  return false;
}

void add_right(const std::vector<Turn>& turns, Things& sequence, Things& left, std::set<Things>& right) {
  std::vector<std::size_t> takes;
  if (is_right(turns, takes, 0, sequence, left)) right.insert(sequence);
  for (std::size_t i = 0; i < left.size(); ++i) {
    const Named next = left[i];
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
    sequence.push_back(next);
    add_right(turns, sequence, left, right);
    sequence.pop_back();
    left.insert(left.begin() + static_cast<std::ptrdiff_t>(i), next);
  }
}

TEST(Turns, AreThoseOfTheDefinitionInRandomScenes) {
  std::mt19937 random(68);
  const auto below = [&random](unsigned n) { return random() % n; };
  const std::vector<std::string> types{"apple", "bowl", "pear"};
  int with_wanted = 0, with_done = 0;
  for (int scene = 0; scene < 600; ++scene) {
    std::vector<Turn> turns;
    for (unsigned t = 0, n = 1 + below(3); t < n; ++t) {
      Turn turn{{{}}, std::nullopt, {}, {}, t > 0 && below(2) == 0};
      for (const std::string& type : types)
        if (below(3) > 0) turn.sets[0].object_types.push_back(type);
      turn.sets[0].textures = colours;
      if (below(4) == 0) turn.sets[0].textures.pop_back();
      if (below(3) > 0) turn.take = 1 + static_cast<int>(below(3));
      for (const Part part : {Part::object_type, Part::texture})
        if (const unsigned condition = below(4); condition < 2)
          (condition == 0 ? turn.same : turn.different).push_back(part);
      turns.push_back(turn);
    }
    Things table, brought;
    for (unsigned i = 0, n = 1 + below(5); i < n; ++i) table.push_back({types[below(3)], colours[below(3)]});
    std::set<Things> right;
    Things sequence, left = table;
    add_right(turns, sequence, left, right);
    const Meaning meaning = in_turns(turns);
    for (unsigned step = 0; step < 4; ++step) {
      std::set<Named> expected;
      for (const Things& one : right)
        if (one.size() > brought.size() && std::equal(brought.begin(), brought.end(), one.begin()))
          expected.insert(one[brought.size()]);
      const Things next = wanted(meaning, table, brought);
      const bool done = right.count(brought) > 0 || (brought.empty() && right.empty());
      ASSERT_EQ(names_of(next), expected) << to_json(meaning) << " scene " << scene << " step " << step;
      ASSERT_EQ(is_done(meaning, table, brought), done) << to_json(meaning) << " scene " << scene << " step " << step;
      with_wanted += !next.empty();
      with_done += done;
      if (table.empty()) break;
      const Named take = next.empty() || below(5) == 0 ? table[below(static_cast<unsigned>(table.size()))] : next[0];
      table.erase(std::find(table.begin(), table.end(), take));
      brought.push_back(take);
    }
  }
  EXPECT_GT(with_wanted, 200);
  EXPECT_GT(with_done, 120);
}

}  // namespace
}  // namespace lgabench
