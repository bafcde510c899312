// The row `errand`: what it learns from demonstrations, and what its policy brings next.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/nobody.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/cell/reference_actor.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/learning/pointing.hpp>
#include <lgabench/plugin/loader.hpp>

#include "../../plugins/hows.hpp"
#include "../../plugins/labels.hpp"
#include "../engine_under_test.hpp"
#include "testing.hpp"

namespace lgabench {
namespace {

Named name_of(const Json& json) { return {json.at(0), json.at(1)}; }

std::vector<Named> names_of(const Json& json) {
  std::vector<Named> names;
  for (const Json& one : json) names.push_back(name_of(one));
  return names;
}

// Written by tests/measure/errands_bayes.py.
TEST(Hows, BayesSaysWhatAnotherComputationSaysInFiftyScenes) {
  const Json scenes = read_json(fs::path(LGABENCH_GOLDEN) / "hows.json");
  ASSERT_EQ(scenes.size(), 50u);
  std::map<std::string, Scenario> scenarios;
  for (const Json& scene : scenes) {
    const std::string id = scene.at("scenario");
    if (scenarios.count(id) == 0) scenarios.emplace(id, load_scenario(id));
    const Scenario& scenario = scenarios.at(id);
    SCOPED_TRACE(scene.at("command"));
    const auto command = std::find_if(scenario.commands.begin(), scenario.commands.end(),
                                      [&](const auto& one) { return scene.at("command") == one.utterance; });
    ASSERT_NE(command, scenario.commands.end());
    Hows hows(command->truth.target);
    for (const Json& one : scene.at("demonstrations")) {
      std::vector<Named> left = names_of(one.at("things")), brought;
      for (const Named& took : names_of(one.at("took"))) {
        hows.saw({left, brought, took});
        left.erase(std::find(left.begin(), left.end(), took));
        brought.push_back(took);
      }
      hows.saw({left, brought, std::nullopt});
    }
    ASSERT_EQ(hows.all().size(), scene.at("probabilities").size());
    for (std::size_t i = 0; i < hows.all().size(); ++i)
      EXPECT_NEAR(hows.all()[i].probability, scene.at("probabilities")[i].get<double>(), 1e-12) << i;
    for (const Json& state : scene.at("states")) {
      const std::vector<Named> on_table = names_of(state.at("on_table"));
      const Hows::Odds odds = hows.odds(on_table, names_of(state.at("brought")));
      EXPECT_NEAR(odds.done, state.at("done").get<double>(), 1e-12);
      for (const auto& [name, of_it] : odds.wanted) {
        const auto at = static_cast<std::size_t>(std::find(on_table.begin(), on_table.end(), name) - on_table.begin());
        EXPECT_NEAR(of_it, state.at("wanted")[at].get<double>(), 1e-12) << name.texture << " " << name.object_type;
      }
    }
  }
}

TEST(Hows, AStepThatNobodyWouldTakeTellsNothing) {
  Hows hows(in_turns({{{{{"apple"}, {"red", "blue"}}}, 1, {}, {}, false}}));
  hows.saw({{{"apple", "red"}, {"bowl", "red"}}, {}, Named{"apple", "red"}});
  const double before = hows.all().front().probability;
  hows.saw({{{"apple", "red"}, {"bowl", "red"}}, {}, Named{"bowl", "red"}});
  EXPECT_EQ(hows.all().front().probability, before);
}

TEST(Labels, EachRuleTellsWhatWasTakenFromWhatWasLeft) {
  const FeatureSpace space{"mine", {"apple", "pear", "bowl", "pallet"}, {"red", "blue"}};
  const std::map<std::string, std::vector<float>> meanings{
      {"apple", {1, 0}}, {"pear", {.8f, .6f}}, {"bowl", {0, 1}}, {"red", {1, 0}}, {"blue", {1, 0}}};
  const EmbeddingOf embedding = [&](const std::string& name) -> const std::vector<float>& { return meanings.at(name); };
  const std::vector<Named> taken{{"apple", "red"}, {"apple", "blue"}, {"apple", "red"}},
      left{{"bowl", "red"}, {"bowl", "blue"}, {"bowl", "red"}};
  const auto in = [&](Labels::Rule rule) { return Labels(rule, taken, left, embedding).in(space); };
  const std::vector<FeatureSet> apples{{{"apple"}, {"red", "blue"}}};
  for (const auto rule : {Labels::Rule::counts, Labels::Rule::names, Labels::Rule::bayes, Labels::Rule::part})
    EXPECT_EQ(in(rule), apples) << static_cast<int>(rule);
  const auto pear = [&](Labels::Rule rule, const std::vector<Named>& took) {
    return Labels(rule, took, left, embedding).belongs({"pear", "red"});
  };
  // A single red pear was taken among blue apples: its type and its texture were rare, together they were not left.
  const std::vector<Named> rare{{"apple", "blue"}, {"apple", "blue"}, {"apple", "blue"}, {"pear", "blue"}};
  EXPECT_FALSE(pear(Labels::Rule::part, rare)) << "red was never taken, of fewer textures than types";
  EXPECT_TRUE(pear(Labels::Rule::bayes, {{"pear", "red"}, {"apple", "red"}}));
  EXPECT_EQ(Labels(Labels::Rule::counts, {}, {}, embedding).in({"mine", {}, {}}), std::vector<FeatureSet>(1));
  const Labels fruit(Labels::Rule::counts, {{"apple", "red"}, {"pear", "blue"}}, left, embedding);
  EXPECT_EQ(fruit.in(space), (std::vector<FeatureSet>{{{"apple", "pear"}, {"red", "blue"}}}))
      << "a set for each list of textures";
}

// A picture with a square for each object, the pallet last.
struct Thing {
  std::uint8_t id;
  Named name;
};
constexpr std::uint8_t pallet = 99;

Observation seen(const std::vector<Thing>& things, const std::vector<Named>& brought = {}) {
  Observation seen;
  seen.size = {40, 80};
  seen.rgb.resize(seen.size.pixels() * 3);
  seen.ids.resize(seen.size.pixels());
  const auto put = [&](std::uint8_t id, Named name, std::size_t row, std::size_t column) {
    for (std::size_t r = row; r < row + 5; ++r)
      for (std::size_t c = column; c < column + 5; ++c) seen.ids[r * 80 + c] = id;
    seen.instances.push_back({id, std::move(name.object_type), std::move(name.texture), 25});
  };
  for (const auto& [id, name] : things) put(id, name, 5, id * 10u);
  put(pallet, {"pallet", "wooden"}, 30, 40);
  seen.brought = brought;
  return seen;
}

const FeatureSet fruit{{"apple", "pear"}, {"red", "blue"}};
const Thing apple{1, {"apple", "red"}}, blue_apple{2, {"apple", "blue"}}, pear{3, {"pear", "red"}},
    bowl{4, {"bowl", "red"}};

struct Silent : TrainingLog {
  void epoch(int, long long, double) override {}
};

// A policy and what it is told, by utterance.
struct Row {
  std::unique_ptr<Policy> policy;
  std::map<std::string, Instruction> told;
};

// With those options; it points at what it is told.
Row learned_from(Json options, const std::map<std::string, Meaning>& commands, const FeatureSpace& space,
                 const std::vector<Demonstration>& demonstrations) {
  static const Catalogue catalogue = scan_plugins({shipped_plugin_directory()});
  const PluginInfo& plugin = catalogue.find("method", "errand");
  options["policy"] = "point";
  const Json all = resolve_options(plugin, options);
  const auto method = load_method(plugin);
  Nobody lm;
  TruthAsHuman human({});
  Silent log;
  Services services{lm, human, all, 1, log, find_environment("tabletop").action_space()};
  services.truth = [&commands](const Command& command) {
    return Selection{commands.at(command.utterance), {}, Provenance::truth, {}, {}, {}};
  };
  services.may_stop = true;
  Row row;
  for (const auto& one : commands) {
    const Command command{one.first, "errands"};
    const Selection selected = method->select(command, space, services);
    row.told[one.first] = {one.first, method->revise(command, selected, demonstrations, services)};
  }
  row.policy = method->learn(demonstrations, services);
  return row;
}

class ErrandRow : public testing::Test {
 protected:
  // `shown`: the takes of the first command's demonstrations.
  std::unique_ptr<Policy> learned(const Json& options, const std::vector<std::vector<Thing>>& shown = {}) {
    std::vector<Demonstration> demonstrations;
    for (const std::vector<Thing>& takes : shown) {
      std::vector<Thing> left{apple, blue_apple, pear, bowl};
      Demonstration one{{commands.begin()->first, {}}, {}};
      std::vector<Named> brought;
      for (const Thing& take : takes) {
        one.steps.push_back({seen(left, brought), pointed_at(seen(left), take.id, actions)});
        left.erase(std::find_if(left.begin(), left.end(), [&](const Thing& other) { return other.id == take.id; }));
        brought.push_back(take.name);
      }
      one.steps.push_back({seen(left, brought), {}});
      demonstrations.push_back(std::move(one));
    }
    Row row = learned_from(options, commands, {"mine", {"apple", "pear", "bowl", "pallet"}, {"red", "blue", "wooden"}},
                           demonstrations);
    told = std::move(row.told);
    row.policy->reset();
    return std::move(row.policy);
  }
  // Ids that it takes one after the other, until it says that nothing is left to do; 0 where it does not. `later`
  // appears after the first.
  std::vector<int> takes(Policy& policy, const std::string& utterance, std::vector<Thing> things,
                         const std::vector<Thing>& later = {}) {
    std::vector<int> ids;
    std::vector<Named> brought;
    policy.reset();
    for (int step = 0; step < 6; ++step) {
      const Observation now = seen(things, brought);
      const Action action = policy.act(now, told.at(utterance));
      if (action.empty()) return ids;
      const auto id = taken({now, action}, actions);
      const auto one = std::find_if(things.begin(), things.end(), [&](const Thing& other) { return other.id == id; });
      ids.push_back(*id);
      brought.push_back(one->name);
      things.erase(one);
      if (step == 0) things.insert(things.end(), later.begin(), later.end());
    }
    ids.push_back(0);
    return ids;
  }
  static std::vector<int> sorted(std::vector<int> ids) {
    std::sort(ids.begin(), ids.end());
    return ids;
  }

  const ActionSpace actions = find_environment("tabletop").action_space();
  const std::string every = "Bring me all the fruit.", each = "Bring me one of each kind of fruit.",
                    two = "Bring me two fruits.";
  const std::map<std::string, Meaning> commands{
      {every, in_turns({{{fruit}, std::nullopt, {}, {}, false}})},
      {each, in_turns({{{fruit}, std::nullopt, {}, {Part::object_type}, false}})},
      {two, in_turns({{{fruit}, 2, {}, {}, false}})}};
  const std::vector<Thing> table{apple, blue_apple, pear, bowl};
  std::map<std::string, Instruction> told;
};

TEST_F(ErrandRow, TheTruthIsAskedAnewAtEachStepOrOnce) {
  const auto anew = learned({}), first = learned({{"moment", "first"}}), plans = learned({{"moment", "planned"}});
  EXPECT_EQ(sorted(takes(*anew, every, table)), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(takes(*anew, each, table).size(), 2u);
  EXPECT_EQ(takes(*anew, two, table).size(), 2u);
  for (const std::string& command : {every, each, two})
    EXPECT_EQ(takes(*first, command, table), takes(*first, every, table)) << "all are wanted at first";
  EXPECT_EQ(sorted(takes(*first, every, table)), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(takes(*plans, each, table).size(), 2u);
  const std::vector<Thing> later{{5, {"pear", "blue"}}};
  EXPECT_EQ(takes(*anew, every, {apple, bowl}, later), (std::vector<int>{1, 5}));
  EXPECT_EQ(takes(*plans, every, {apple, bowl}, later), (std::vector<int>{1}));
  EXPECT_EQ(takes(*first, every, {apple, bowl}, later), (std::vector<int>{1}));
  EXPECT_TRUE(takes(*anew, every, {bowl}).empty());
}

TEST_F(ErrandRow, WhoDoesNotHearTheHowActsAlike) {
  for (const char* how : {"all", "two"}) {
    const auto deaf = learned({{"how", how}});
    EXPECT_EQ(takes(*deaf, every, table), takes(*deaf, each, table)) << how;
    EXPECT_EQ(takes(*deaf, every, table).size(), how == std::string("two") ? 2u : 3u);
  }
  const auto hears = learned({{"how", "words"}});
  EXPECT_EQ(takes(*hears, each, table).size(), 2u);
  EXPECT_EQ(takes(*hears, two, table).size(), 2u);
  const auto hears_each = learned({{"how", "each"}});
  EXPECT_EQ(takes(*hears_each, each, table).size(), 2u);
  EXPECT_EQ(takes(*hears_each, two, table).size(), 3u);
  EXPECT_EQ(told.at(two).selection.target.turns.size(), 1u) << "what is told is recorded";
}

TEST_F(ErrandRow, DemonstrationsSayWhatBelongsAndHow) {
  const std::vector<std::vector<Thing>> apples{{apple, blue_apple}, {blue_apple, apple}, {apple, blue_apple}};
  const auto labels = learned({{"sets", "counts"}, {"how", "all"}}, apples);
  EXPECT_EQ(sorted(takes(*labels, every, table)), (std::vector<int>{1, 2}));
  EXPECT_EQ(takes(*labels, every, table), takes(*labels, two, table));
  const auto alike = learned({{"how", "shown"}}, apples);
  EXPECT_EQ(sorted(takes(*alike, every, table)), (std::vector<int>{1, 2})) << "two of one type, as it was shown";
  const auto habit = learned({{"how", "habit"}}, apples);
  EXPECT_EQ(takes(*habit, every, table).size(), 2u);
}

TEST_F(ErrandRow, ToldSomethingElseItBringsThat) {
  const auto shown = learned({{"how", "shown"}}, {{apple, blue_apple}, {blue_apple, apple}});
  told.at(every).selection.target = commands.at(every);
  EXPECT_EQ(takes(*shown, every, table).size(), 3u);
}

TEST_F(ErrandRow, AnObjectKeepsTheNameOfItsReadings) {
  const Thing misread{1, {"bowl", "red"}};
  const auto policy = [&](const char* names) { return learned({{"readings", names}}); };
  const auto acts = [&](Policy& of, const std::vector<Thing>& things, const std::vector<Named>& brought = {}) {
    const Observation now = seen(things, brought);
    const Action action = of.act(now, told.at(each));
    return action.empty() ? 0 : static_cast<int>(*taken({now, action}, actions));
  };
  const auto anew = policy("each"), first = policy("first"), majority = policy("majority");
  for (Policy* one : {anew.get(), first.get(), majority.get()}) {
    one->reset();
    EXPECT_EQ(acts(*one, {apple, bowl}), 1);
  }
  EXPECT_EQ(acts(*anew, {misread, bowl}), 0);
  EXPECT_EQ(acts(*first, {misread, bowl}), 1);
  EXPECT_EQ(acts(*majority, {misread, bowl}), 1) << "of two the first";
  EXPECT_EQ(acts(*majority, {misread, bowl}), 0);
  EXPECT_EQ(acts(*first, {pear, bowl}, {misread.name}), 3) << "what was brought was an apple";
  first->reset();
  EXPECT_EQ(acts(*first, {misread, bowl}), 0) << "another episode";
}

// The pairs of a scenario, and who plays them.
class ErrandPairs : public testing::Test {
 protected:
  static constexpr int pairs = 16;

  std::vector<Episode> played(const Actor& actor) {
    std::vector<TestScene> scenes;
    for (int index = 0; index < 2 * pairs; ++index)
      scenes.push_back({test_scene(scenario, "continuous", "told", 7, index)});
    return evaluate(*environment, scenes, actor, [](int) {});
  }
  std::vector<Episode> played(const Json& options) {
    std::map<std::string, Meaning> commands;
    for (const ScenarioCommand& one : scenario.commands) commands[one.utterance] = one.truth.target;
    if (demonstrations.empty()) demonstrate();
    const Row row = learned_from(options, commands, scenario.space, demonstrations);
    std::vector<Instruction> told;
    for (const ScenarioCommand& one : scenario.commands) told.push_back(row.told.at(one.utterance));
    return played(policy_actor(*row.policy, told, "errand"));
  }
  // Both right.
  static double won(const std::vector<Episode>& episodes) {
    double won = 0;
    for (std::size_t k = 0; k < episodes.size(); k += 2) won += episodes[k].success() && episodes[k + 1].success();
    return won / pairs;
  }
  // Until the judge ends one of them.
  static bool alike(const std::vector<Episode>& episodes) {
    for (std::size_t k = 0; k < episodes.size(); k += 2) {
      const std::vector<Action> one = episodes[k].actions(), other = episodes[k + 1].actions();
      const auto common = static_cast<std::ptrdiff_t>(std::min(one.size(), other.size()));
      if (!std::equal(one.begin(), one.begin() + common, other.begin())) return false;
    }
    return true;
  }

  const Scenario scenario = load_scenario("errands_fruit");
  const std::unique_ptr<Environment> environment = make_environment(scenario, make_engine());

 private:
  void demonstrate() {
    const int seen = static_cast<int>(std::count_if(scenario.commands.begin(), scenario.commands.end(),
                                                    [](const ScenarioCommand& one) { return one.seen; }));
    for (int i = 0; i < 5 * seen; ++i) {
      const Scene scene = training_scene(scenario, "continuous", {}, 1, i);
      Demonstration one{{scenario.commands.at(static_cast<std::size_t>(scene.command)).utterance, {}}, {}};
      Observation now = environment->reset(scene);
      while (true) {
        one.steps.push_back({now, environment->expert_action()});
        StepResult result = environment->step(one.steps.back().label);
        if (result.terminated || result.truncated) break;
        now = std::move(result.observation);
      }
      demonstrations.push_back(std::move(one));
    }
  }

  std::vector<Demonstration> demonstrations;
};

TEST_F(ErrandPairs, TheTruthIsRightInBothAndWhoHearsNoHowInNone) {
  EXPECT_EQ(won(played(reference_actor("oracle"))), 1);
  EXPECT_GE(won(played(Json::object())), .95);
  EXPECT_GE(won(played({{"moment", "planned"}})), .95);
  const auto each = played({{"how", "words"}});
  EXPECT_GE(won(each), .95) << "all, and one of each";
  for (const Json& deaf : {Json{{"moment", "first"}}, Json{{"how", "all"}}, Json{{"how", "two"}},
                           Json{{"sets", "counts"}, {"how", "all"}}, Json{{"sets", "part"}, {"how", "all"}}}) {
    const auto episodes = played(deaf);
    EXPECT_TRUE(alike(episodes)) << deaf;
    EXPECT_EQ(won(episodes), 0) << deaf;
  }
  EXPECT_FALSE(alike(each));
  EXPECT_LE(won(played({{"sets", "counts"}})), .5);
}

// Whoever stops without hearing the words does alike in both scenes of a pair.
TEST_F(ErrandPairs, ReferencesThatStopActAlike) {
  for (const std::string row : {"stops_at_once", "two_then_stops", "stops_at_random"}) {
    const std::vector<Episode> episodes = played(reference_actor(row));
    std::set<std::size_t> lengths;
    for (const Episode& one : episodes) lengths.insert(one.actions().size());
    EXPECT_TRUE(alike(episodes)) << row;
    EXPECT_EQ(won(episodes), 0) << row;
    EXPECT_EQ(lengths == std::set<std::size_t>{1}, row == "stops_at_once");
    EXPECT_TRUE(*lengths.rbegin() == 3 || row != "two_then_stops");
  }
}

}  // namespace
}  // namespace lgabench
