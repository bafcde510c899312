#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <numeric>

#include <lgabench/drawn/lexicon.hpp>
#include <lgabench/drawn/person_belief.hpp>

namespace lgabench::drawn {
namespace {

constexpr std::uint64_t practice = 1;  // the published practice seed
constexpr int forever = std::numeric_limits<int>::max();

const PersonGrammar& grammar() {
  static const PersonGrammar shipped = person_grammar(load_feature_space("household"));
  return shipped;
}

// A person with scenes on a plain table.
struct Met {
  Person person;
  std::vector<PersonRule> rules;
  RandomStream random;
  const PersonGrammar::Words& words() const { return *words_in(grammar(), person.utterance); }
  Places places() {
    return [this](std::vector<Thing>& things) { return place_plainly(things, random); };
  }
  // The person's thing first.
  Standing test() {
    return {draw_rivals(rules, &person.rule, plain_goal, random, places(), forever)->things, plain_goal, {}};
  }
  std::pair<Standing, std::size_t> shown() {
    const auto scene = draw_natural(grammar(), words(), person.rule, plain_goal, random, places(), forever);
    return {{scene->things, plain_goal, {}}, scene->taken};
  }
};

std::vector<Met> meet(std::uint64_t seed, int count) {
  std::vector<Met> all;
  for (Person& person : draw_persons(grammar(), seed, 0, count)) {
    auto rules = rules_of(grammar(), words_in(grammar(), person.utterance)->types);
    all.push_back({person, std::move(rules), RandomStream(fmt::format("met/{}/{}", seed, all.size()))});
  }
  return all;
}

// The share of those that are chosen, which score most, that is the first.
double first_among_most(const std::vector<double>& scores) {
  const double most = *std::max_element(scores.begin(), scores.end()) - 1e-9;
  const auto chosen = std::count_if(scores.begin(), scores.end(), [most](double one) { return one >= most; });
  return scores.front() >= most ? 1. / static_cast<double>(chosen) : 0;
}

TEST(Persons, ARuleThatDidNotLearnIsAtChance) {
  std::map<std::string, double> sums;
  int scenes = 0;
  for (Met& met : meet(practice, 400)) {
    const Belief prior(met.rules);
    for (int i = 0; i < 5; ++i, ++scenes) {
      const Standing seen = met.test();
      const auto shares = [&](bool types, bool looks) {
        std::vector<double> shared;
        for (const Thing& one : seen.things) {
          double count = 0;
          for (const Thing& other : seen.things) {
            count += types && one.type == other.type;
            for (const auto& look : grammar().looks) {
              const auto has = [&](const Thing& thing) {
                return std::count(look.textures.begin(), look.textures.end(), grammar().space.textures[thing.texture]) >
                       0;
              };
              count += looks && has(one) == has(other);
            }
          }
          shared.push_back(count);
        }
        return shared;
      };
      const auto negative = [](std::vector<double> all) {
        for (double& one : all) one = -one;
        return all;
      };
      std::vector<double> columns, rows;
      for (const Thing& one : seen.things) columns.push_back(one.column), rows.push_back(one.row);
      sums["most shared"] += first_among_most(shares(true, true));
      sums["odd in looks"] += first_among_most(negative(shares(false, true)));
      sums["common in looks"] += first_among_most(shares(false, true));
      sums["odd type"] += first_among_most(negative(shares(true, false)));
      sums["common type"] += first_among_most(shares(true, false));
      sums["leftmost"] += first_among_most(negative(columns));
      sums["rightmost"] += first_among_most(columns);
      sums["top"] += first_among_most(negative(rows));
      std::vector<double> numbers;
      for (const Thing& one : seen.things) numbers.push_back(-static_cast<double>(one.type));
      sums["type first in the space"] += first_among_most(numbers);
      sums["most frequent rule"] += first_among_most([&] {
        std::vector<double> held(seen.things.size(), 0);
        for (const std::size_t one : taken_by(prior.rules()[prior.likeliest()], seen.things, seen.goal)) held[one] = 1;
        return held;
      }());
      sums["likeliest by the prior"] += first_among_most(prior.takes(seen));
    }
  }
  for (const auto& [name, sum] : sums) {
    RecordProperty(name, fmt::format("{:.3f}", sum / scenes));
    EXPECT_NEAR(sum / scenes, .2, .04) << name;
  }
}

TEST(Persons, ExactBayesLearnsAndLeavesRoomBelowTheVoteInEachScene) {
  double bayes = 0, vote = 0, places = 0;
  constexpr int persons = 150, tests = 6, demonstrations = 3;
  for (Met& met : meet(practice, persons)) {
    Belief belief(met.rules);
    for (int i = 0; i < demonstrations; ++i) {
      const auto [seen, taken] = met.shown();
      belief.took(seen, taken);
    }
    for (int i = 0; i < tests; ++i) {
      const Standing seen = met.test();
      std::vector<double> held(seen.things.size(), 0);
      for (const std::size_t one : taken_by(belief.rules()[belief.likeliest()], seen.things, seen.goal)) held[one] = 1;
      bayes += first_among_most(held) / (persons * tests);
      vote += first_among_most(belief.takes(seen)) / (persons * tests);
    }
    places += met.person.rule.place.has_value() / (1. * persons);
  }
  EXPECT_NEAR(bayes, .75, .06);
  EXPECT_GE(vote - bayes, .08);
  EXPECT_GE(places, 1. / 3);
}

TEST(Persons, ARuleIsAMeaningAndTakesWhatTheMeaningGrounds) {
  for (Met& met : meet(practice, 20)) {
    const Standing seen = met.test();
    std::vector<Placed> visible{{{9, "pallet", "wooden", 1}, plain_goal.row, plain_goal.column}};
    for (std::size_t i = 0; i < seen.things.size(); ++i)
      visible.push_back({{static_cast<std::uint8_t>(i + 1), grammar().space.object_types[seen.things[i].type],
                          grammar().space.textures[seen.things[i].texture], 1},
                         seen.things[i].row,
                         seen.things[i].column});
    const Standing again = standing(visible, grammar().space);
    EXPECT_EQ(again.ids, (std::vector<std::uint8_t>{1, 2, 3, 4, 5}));
    for (std::size_t r = 0; r < met.rules.size(); r += 7) {
      const Meaning meaning = meaning_of(met.rules[r], grammar().space);
      const auto back = rule_of(meaning, grammar().space);
      ASSERT_TRUE(back && same(*back, met.rules[r]));
      std::vector<std::uint8_t> ids;
      for (const std::size_t one : taken_by(met.rules[r], again.things, again.goal)) ids.push_back(again.ids[one]);
      EXPECT_EQ(ids, grounded(meaning, visible));
    }
  }
}

TEST(Persons, ARuleSaysSomethingThatCanBeShown) {
  for (const auto& words : grammar().words) {
    const auto rules = rules_of(grammar(), words.types);
    double sum = 0;
    for (const PersonRule& rule : rules) {
      sum += rule.prior;
      EXPECT_GT(rule.types.count(), 0u);
      EXPECT_GT(rule.textures.count(), 0u);
      EXPECT_NE(rule.types.count() + 1, words.types.size() == 2 ? 0 : words.types.size()) << "all but one type";
      EXPECT_FALSE(!rule.place && rule.types.count() == words.types.size() &&
                   rule.textures.count() == grammar().space.textures.size());
    }
    EXPECT_NEAR(sum, 1, 1e-9);
  }
  const Lexicon lexicon = load_lexicon({});
  for (const auto& words : grammar().words) {
    const auto same_words = [&words](const Things& things) {
      return things.a == words.a && things.types.size() == words.types.size();
    };
    EXPECT_TRUE(std::any_of(lexicon.classes.begin(), lexicon.classes.end(), same_words)) << words.a;
  }
}

TEST(Persons, ABeliefIsBayesRule) {
  PersonRule first, second;  // of type 0, and of texture 0
  first.types.set(0), first.textures.set(), first.prior = .5;
  second.types.set(), second.textures.set(0), second.prior = .5;
  const Standing seen{{{0, 0, 0, 0}, {0, 1, 0, 50}, {1, 1, 0, 90}}, plain_goal, {}};
  Belief belief({first, second});
  belief.took(seen, 0);  // 1/2 and 1
  EXPECT_NEAR(belief.probabilities()[0], 1. / 3, 1e-12);
  EXPECT_NEAR(belief.takes(seen)[0], 1. / 3 / 2 + 2. / 3, 1e-12);
  belief.said(seen, 1, true, .05);  // .95 and .05
  EXPECT_NEAR(belief.probabilities()[0], 19. / 21, 1e-12);
  EXPECT_EQ(belief.likeliest(), 0u);
  Belief asked({first, second});
  asked.said(seen, std::optional<std::size_t>(1), .05);  // .5 * .95 + .5 * .05/3, and .05/3
  const double right = .5 * .95 + .5 * .05 / 3, wrong = .05 / 3;
  EXPECT_NEAR(asked.probabilities()[0], right / (right + wrong), 1e-12);
  EXPECT_NEAR(asked.expected_bits(seen, 2, .05), 0, 1e-12) << "neither rule takes it";
  EXPECT_GT(Belief({first, second}).expected_bits(seen, 1, .05), .5);
  belief.took(seen, 2);  // which no rule makes possible
  EXPECT_NEAR(belief.probabilities()[0], 19. / 21, 1e-12);
}

TEST(Persons, AHintLeavesRulesThatHaveItsParts) {
  Json json = person_grammar_json();
  json["hints"] = Json::parse(R"([{"says": "It is soup.", "words": ["a piece of cutlery"], "types": [["spoon"]]},
                                  {"says": "No stripes.", "looks": ["not striped", "dotted"]},
                                  {"says": "A side.", "places": ["leftmost", "rightmost"]}])");
  const PersonGrammar mine = read_person_grammar(json, grammar().space, "mine.json");
  EXPECT_EQ(hint_in(mine, "Bring person 1 a fruit."), nullptr);
  EXPECT_EQ(words_in(mine, "Bring person 1 a fruit. It is soup."), nullptr) << "a hint of other words";
  EXPECT_EQ(words_in(mine, "Bring person 1 a piece of cutlery. It is soup.")->a, "a piece of cutlery");
  EXPECT_EQ(hint_in(mine, "Bring person 1 a fruit. No stripes."), &mine.hints[1]);
  const auto rules = rules_of(mine, mine.words[0].types);
  double prior = 0;
  const auto left = left_by(mine.hints[1], rules);
  for (const PersonRule& rule : left) {
    const Meaning meaning = meaning_of(rule, mine.space);
    const auto& textures = meaning.sets.front().textures;
    const bool striped = std::find(textures.begin(), textures.end(), "red and blue stripe") != textures.end();
    const bool plain = std::find(textures.begin(), textures.end(), "red") != textures.end();
    EXPECT_FALSE(striped);
    EXPECT_EQ(plain, textures.size() > 30) << "dotted or not striped";
    prior += rule.prior;
  }
  EXPECT_NEAR(prior, 1, 1e-9);
  const auto sides = left_by(mine.hints[2], rules);
  EXPECT_TRUE(std::all_of(sides.begin(), sides.end(), [](const PersonRule& rule) {
    return rule.place == Which::Rule::leftmost || rule.place == Which::Rule::rightmost;
  }));
  const auto persons = draw_persons(mine, practice, 0, 40, true);
  for (const Person& person : persons) {
    ASSERT_NE(words_in(mine, person.utterance), nullptr) << person.utterance;
    EXPECT_TRUE(leaves(*hint_in(mine, person.utterance), person.rule)) << person.utterance;
  }
  EXPECT_EQ(draw_persons(mine, practice, 10, 1, true).front().utterance, persons[10].utterance);
}

TEST(Persons, AHostileGrammarIsRefused) {
  const auto refused = [](const std::string& place, const Json& value) {
    Json json = person_grammar_json();
    json[Json::json_pointer(place)] = value;
    try {
      read_person_grammar(json, grammar().space, "mine.json");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const auto says = [](const std::string& text, const std::string& words) {
    return text.find(words) != std::string::npos;
  };
  EXPECT_PRED2(says, refused("/prior/types/one", .4), "mine.json: /prior/types: expected shares that add up to 1");
  EXPECT_PRED2(says, refused("/prior/looks/any", -.1), "/prior/looks/any: expected a share, 0 or more");
  EXPECT_PRED2(says, refused("/words/0/types/1", "dragon"), "/words/0/types/1: expected an object type");
  EXPECT_PRED2(says, refused("/words/0/types", {"apple", "pear"}), "/words/0/types: expected three object types");
  EXPECT_PRED2(says, refused("/looks/0/textures", {"no such *"}), "/looks/0/textures: expected some textures");
  EXPECT_PRED2(says, refused("/looks/0/textures", {"*"}), "/looks/0/textures: expected some textures");
  EXPECT_PRED2(says, refused("/more", 1), "mine.json: ");
  const auto hint = [&refused](const char* member, const Json& value) {
    return refused("/hints", Json::array({{{"says", "A hint."}, {member, value}}}));
  };
  EXPECT_PRED2(says, hint("looks", {"plaid"}),
               "/hints/0/looks/0: expected a look of the grammar, or \"not \" and a look");
  EXPECT_PRED2(says, hint("places", {"left_of"}), "/hints/0/places/0: expected a place of the grammar");
  EXPECT_PRED2(says, hint("types", {{"dragon"}}), "/hints/0/types/0: expected object types of the feature space");
  EXPECT_PRED2(says, hint("types", {{"apple"}}), "/hints/0: expected parts that some rules of \"a packaged drink\"");
  EXPECT_PRED2(says, hint("words", {"a dragon"}), "/hints/0/words: expected words of the grammar");
}

}  // namespace
}  // namespace lgabench::drawn
