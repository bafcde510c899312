// What a person leaves unsaid: weighed by what they take, and by what they say of an object.
#include <lgabench/abstraction/preference.hpp>

#include <gtest/gtest.h>

#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/core/scenario.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

const FeatureSpace space{"test", {"apple", "banana", "pear", "pallet"}, {"red", "blue"}};
const Meaning words{{"apple", "banana"}, {"red", "blue"}};
const std::vector<Hypothesis> hypotheses{{"apples", {{"apple"}, {"red", "blue"}}},
                                         {"what is red", {{"apple", "banana"}, {"red"}}}};

// A row of objects, a pixel each, from id 1 on.
Observation row_of(const std::vector<std::pair<std::string, std::string>>& objects) {
  Observation seen;
  seen.size = {1, static_cast<int>(objects.size())};
  for (const auto& [type, texture] : objects) {
    const auto id = static_cast<std::uint8_t>(seen.ids.size() + 1);
    seen.ids.push_back(id);
    seen.instances.push_back({id, type, texture, 1});
  }
  return seen;
}

// Takes hold at (grasp, 0), in columns of a picture that is `columns` wide and one row high, and leads to `to`.
ActionSpace in_a_row(int columns) {
  ActionSpace actions;
  for (const char* name : {"down", "from", "to"}) actions.numbers.push_back({name, "", 0, 1.0 * columns});
  actions.numbers[0].high = 1;
  actions.places = {{0, 1}, {0, 2}};
  return actions;
}
Demonstration shown(Observation seen, double from, double to, const std::string& utterance = "Bring me some fruit.") {
  return {{utterance, {}}, {{std::move(seen), {.5, from, to}}}};
}

TEST(Preference, IsWeighedByWhatWasTaken) {
  Preference preference(words, hypotheses, space);
  for (const double p : preference.probabilities()) EXPECT_NEAR(p, 1.0 / 3, 1e-12);

  // Of apple, banana and pear (the pallet does not count): .95/2 and twice .95/1. Equal: the narrower, then the first.
  preference.took(row_of({{"apple", "red"}, {"banana", "blue"}, {"pear", "red"}, {"pallet", "red"}}), 1);
  EXPECT_NEAR(preference.probabilities()[0], .2, 1e-12);
  EXPECT_NEAR(preference.probabilities()[2], .4, 1e-12);
  EXPECT_EQ(preference.ranked(), (std::vector<std::size_t>{1, 2, 0}));

  // .95/2, .95/1, and .05/2 of what holds neither: 1 * 19 : 2 * 38 : 2 * 1.
  preference.took(row_of({{"apple", "blue"}, {"banana", "blue"}}), 1);
  const std::vector<double> after = preference.probabilities();
  EXPECT_NEAR(after[0], 19.0 / 97, 1e-12);
  EXPECT_NEAR(after[1], 76.0 / 97, 1e-12);
  EXPECT_NEAR(after[2], 2.0 / 97, 1e-12);
  EXPECT_EQ(preference.ranked(), (std::vector<std::size_t>{1, 0, 2}));

  // 19 * .05 : 76 * .95 : 2 * .05
  preference.said("banana", "red", false);
  EXPECT_NEAR(preference.probabilities()[1], 72.2 / 73.25, 1e-12);
}

TEST(Preference, SharesItsPriorByWeightsAndWithWhatNobodyListed) {
  std::vector<Hypothesis> weighed = hypotheses;
  weighed[0].weight = 3;  // the words have the mean, 2
  const std::vector<Hypothesis> unlisted{{"blue", {{"apple", "banana"}, {"blue"}}, 1},
                                         {"apples, too", {{"apple"}, {"red", "blue"}}, 3}};
  const Preference preference(words, weighed, space, unlisted, .4);
  const std::vector<double> expected{.6 * 2 / 6, .6 * 3 / 6 + .4 * 3 / 4, .6 * 1 / 6, .4 * 1 / 4};
  ASSERT_EQ(preference.candidates().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(preference.probabilities()[i], expected[i], 1e-12);
}

TEST(Preference, LeavesOutWhatHoldsTheSameObjects) {
  std::vector<Hypothesis> twice = hypotheses;
  twice.push_back({"the words again", {{"banana", "apple"}, {"blue", "red"}}});
  twice.push_back({"apples again", {{"apple"}, {"blue", "red"}}});
  const Preference preference(words, twice, space);
  ASSERT_EQ(preference.candidates().size(), 3u);
  EXPECT_EQ(preference.candidates()[2].text, "what is red");
  EXPECT_NEAR(preference.probabilities()[1], 2.0 / 5, 1e-12);
  EXPECT_EQ(Preference(words, {}, space).probabilities(), std::vector<double>{1});
}

#define EXPECT_REFUSED(call, words) EXPECT_SAYS(message_of<MethodError>([&] { call; }), words)

Scenario asked_scenario() {
  Scenario scenario;
  scenario.id = "asked";
  ScenarioCommand command;
  command.utterance = "Bring me some fruit.";
  command.truth.target = Meaning({"apple"}, {"red", "blue"});
  scenario.commands = {command};
  scenario.questions = Scenario::Questions{2, 0};
  return scenario;
}

TEST(AskedInScenes, CountsQuestionsAndRefusesWhatCannotBeAsked) {
  const Scenario scenario = asked_scenario();
  const Command command = scenario.command(0);
  int looked = 0;
  AskedInScenes person(scenario, 1, 5, [&looked](int, int) {
    ++looked;
    return std::vector<Placed>{
        {{1, "apple", "red", 1}, 0, 0}, {{2, "pear", "red", 1}, 0, 5}, {{3, "pallet", "red", 1}, 0, 9}};
  });
  EXPECT_TRUE(person.takes(command, 0, 1));
  EXPECT_FALSE(person.takes(command, 2, 2));
  EXPECT_EQ(person.which(command, 0), std::optional<std::uint8_t>(1));
  EXPECT_EQ(looked, 2) << "a scene is drawn once";
  EXPECT_REFUSED(person.takes(command, 0, 1), "expected at most 5 questions to a person");
  EXPECT_REFUSED(person.accepts(command, "apple", "red"), "expected at most 5 questions to a person");
  EXPECT_REFUSED(person.scene(command, 3), "0 to 2, got 3");
  AskedInScenes other(scenario, 1, 5, [](int, int) { return std::vector<Placed>{{{3, "pallet", "red", 1}, 0, 9}}; });
  EXPECT_REFUSED(other.takes(command, 0, 3), "expected an object that is in it");
  EXPECT_EQ(other.which(command, 0), std::nullopt);
}

TEST(AskedInScenes, ErrsAlikeHoweverOftenItIsAsked) {
  Scenario scenario = asked_scenario();
  scenario.questions->errs = .5;
  const Command command = scenario.command(0);
  AskedInScenes person(scenario, 100, 1000, [](int, int) {
    return std::vector<Placed>{{{1, "apple", "red", 1}, 0, 0}, {{2, "pear", "red", 1}, 0, 5}};
  });
  int right = 0;
  for (int i = 0; i < 100; ++i) {
    const bool said = person.takes(command, i, 1);
    EXPECT_EQ(said, person.takes(command, i, 1));
    right += said;
  }
  EXPECT_GT(right, 30);
  EXPECT_LT(right, 70);
}

// Knows the hypotheses above, or none; counts.
class Supposing : public LanguageModel {
 public:
  std::vector<bool> answer(const Command&, const FeatureSpace&, const std::vector<Question>&) override { return {}; }
  std::vector<Hypothesis> hypotheses(const Command&, const FeatureSpace&) override {
    ++asked;
    return known;
  }
  std::string model() const override { return "a model"; }
  Provenance provenance() const override { return Provenance::recorded; }
  SelectionCost cost() const override { return {}; }
  std::vector<Hypothesis> known = lgabench::hypotheses;
  int asked = 0;
};

struct TakesNoBananas : HumanAnswers {
  Selection specify(const Command&) override { return {}; }
  Selection edit(const Command&, const Selection& proposal) override { return proposal; }
  bool accepts(const Command&, const std::string& object_type, const std::string& texture) override {
    asked.push_back(object_type + ", " + texture);
    return object_type != "banana";
  }
  std::vector<std::string> asked;
};

struct NoLog : TrainingLog {
  void epoch(int, long long, double) override {}
};

class Preferred : public testing::Test {
 protected:
  Selection preferred(const std::vector<Demonstration>& demonstrations, int questions) {
    Selection selected;
    selected.target = words;
    return lgabench::preferred({"Bring me some fruit.", "pick_and_place"}, selected, space, demonstrations, services_,
                               {questions});
  }
  const std::vector<Demonstration> two_apples{
      shown(row_of({{"pear", "red"}, {"apple", "red"}, {"banana", "blue"}}), 1.5, 0),
      shown(row_of({{"pear", "red"}, {"apple", "blue"}, {"banana", "blue"}}), 1.5, 0)};

  Supposing model_;
  TakesNoBananas person_;
  NoLog log_;
  Json options_ = Json::object();
  ActionSpace actions_ = in_a_row(3);
  Services services_{model_, person_, options_, 0, log_, actions_, {}, {}, true};
};

TEST_F(Preferred, IsWhatExplainsTheDemonstrationsBest) {
  EXPECT_EQ(preferred(two_apples, 0).target, hypotheses[0].meaning);
  EXPECT_TRUE(person_.asked.empty());
  EXPECT_EQ(preferred({two_apples[0]}, 0).target, hypotheses[0].meaning) << "of equals the narrower, then the first";
  std::vector<Demonstration> of_another_command = two_apples;
  for (Demonstration& one : of_another_command) one.instruction.utterance = "Bring me a pear.";
  EXPECT_EQ(preferred(of_another_command, 0).target, words);
}

TEST_F(Preferred, ShowsAPersonTheObjectOfWhichItIsLeastCertain) {
  const Demonstration among_red = shown(row_of({{"pear", "red"}, {"apple", "red"}, {"banana", "red"}}), 1.5, 0);
  EXPECT_EQ(preferred({among_red}, 3).target, hypotheses[0].meaning);
  EXPECT_EQ(person_.asked, std::vector<std::string>{"banana, red"}) << "and nothing else in view tells more";
  person_.asked.clear();
  preferred({shown(row_of({{"apple", "red"}, {"pear", "red"}}), .5, 0)}, 1);
  EXPECT_TRUE(person_.asked.empty()) << "nothing in view tells them apart";

  model_.known[0].weight = 3;  // apples 3 : what is red 1 : the words 2 / 2, once a red apple was taken
  preferred({shown(row_of({{"apple", "red"}, {"apple", "blue"}, {"banana", "red"}}), .5, 0)}, 1);
  EXPECT_EQ(person_.asked, std::vector<std::string>{"banana, red"}) << "not what the likeliest two differ on first";
}

TEST_F(Preferred, StaysWhatTheWordsSayWhereNothingTellsMore) {
  services_.shows_truth = false;
  EXPECT_EQ(preferred(two_apples, 1).target, words);
  EXPECT_EQ(model_.asked, 0);
  services_.shows_truth = true;
  model_.known.clear();
  testing::internal::CaptureStdout();
  EXPECT_EQ(preferred(two_apples, 1).target, words);
  EXPECT_SAYS(testing::internal::GetCapturedStdout(), "no hypotheses are known");
  EXPECT_TRUE(person_.asked.empty());
}

TEST(Preference, OfACommandIsRecordedForThoseOfTheSuiteAlone) {
  for (const std::string& id : scenario_ids()) {
    const Scenario scenario = load_scenario(id);
    if (id.rfind("words_", 0) != 0) continue;
    RecordedLanguageModel model(scenario, scenario.recorded);
    const std::size_t count = model.hypotheses(scenario.command(0), scenario.space).size();
    EXPECT_EQ(count, id.rfind("words_preference_", 0) == 0 ? 6u : 0u) << id;
    EXPECT_EQ(model.cost().lm_queries, count > 0 ? 1 : 0) << id;
  }
}

TEST(Taken, IsWhatLiesUnderTheGraspOrOnTheWay) {
  const ActionSpace actions = in_a_row(40);
  Observation seen;
  seen.size = {1, 40};
  seen.ids.assign(40, 0);
  for (const auto& [id, type, from, to] : {std::tuple{1, "pallet", 0, 4}, {2, "apple", 12, 14}, {3, "pear", 26, 28}}) {
    for (int i = from; i < to; ++i) seen.ids[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(id);
    seen.instances.push_back({static_cast<std::uint8_t>(id), type, "red", to - from});
  }
  const auto at = [&](double from, double to) { return taken(shown(seen, from, to), actions); };
  EXPECT_EQ(at(13, 1), 2);
  EXPECT_EQ(at(15, 40), 2) << "beside its edge";
  EXPECT_EQ(at(17, 40), 3) << "pushed away from what is nearer";
  EXPECT_EQ(at(24.6, 0), 3) << "within two pixels";
  EXPECT_EQ(at(22, 0), 2);
  EXPECT_EQ(at(35, 40), 3) << "nothing on the way";
  EXPECT_EQ(at(2, 3), 2) << "never the pallet";
  seen.ids.assign(40, 0);
  EXPECT_EQ(at(13, 1), std::nullopt);
}

}  // namespace
}  // namespace lgabench
