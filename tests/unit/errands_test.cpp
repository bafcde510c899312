// Errands: what a step's end says of them, their scenes in pairs, and episodes on an engine.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/cell/reference_actor.hpp>
#include <lgabench/core/turns.hpp>
#include <tabletop/content.hpp>
#include <tabletop/errand.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/task.hpp>

#include "../engine_under_test.hpp"
#include "testing.hpp"

namespace lgabench::tabletop {
namespace {

// Those whose words say how objects are used, or all.
std::vector<std::string> errands(bool told) {
  std::vector<std::string> ids;
  for (const std::string& id : scenario_ids())
    if (id.rfind("errands_", 0) == 0 && !(told && id.find("_shown_") != id.npos)) ids.push_back(id);
  return ids;
}

SceneRequest request(const std::string& arm) { return {"continuous", arm == "train" ? "train" : "test", arm, 7}; }

const std::vector<std::string> fruit_names{"apple", "pear", "lemon"};

Meaning fruit(std::optional<int> take, std::vector<Part> same, std::vector<Part> different) {
  const FeatureSet sets{fruit_names, {"red", "blue"}};
  return in_turns({{{sets}, take, std::move(same), std::move(different), false}});
}

// Objects in a row, each named "TEXTURE TYPE", and a pallet.
Scene table(Meaning meaning, const std::vector<std::string>& names) {
  Scene scene;
  scene.task = "errands";
  double y = -.45;
  for (const std::string& name : names) {
    const auto at = name.find(' ');
    scene.objects.push_back({name.substr(at + 1), name.substr(0, at), role::distractor, {.5, y += .1}, 0, 0});
  }
  scene.objects.push_back({goal_type, goal_texture, role::goal, {.5, .3}, 0, 0});
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    scene.objects[i].instance_id = static_cast<std::uint8_t>(i + 1);
  scene.errand = std::move(meaning);
  return scene;
}

struct Played {
  explicit Played(Scene of) : scene(std::move(of)), errand(scene) {
    for (const SceneObject& o : scene.objects) poses.push_back({{o.position_m.x, o.position_m.y, 0}, {}});
  }
  // Where they end; suction took the first of them.
  Failure moves(const std::vector<std::pair<std::size_t, Vec2>>& to, bool is_taken = true) {
    for (const auto& [object, at] : to) poses[object].position_m = {at.x, at.y, 0};
    Motion motion;
    if (is_taken) motion.taken = static_cast<int>(to.front().first);
    return errand.moved(poses, motion);
  }
  Failure brings(std::size_t object) { return moves({{object, goal}}); }

  static constexpr Vec2 goal{.5, .3}, away{.5, .6};
  Scene scene;
  Errand errand;
  std::vector<Pose> poses;
};

TEST(Errand, EachWayInWhichItEndsHasItsWord) {
  const Scene two = table(fruit(2, {Part::texture}, {}), {"red apple", "blue pear", "red lemon", "red bowl"});
  {
    Played played(two);
    EXPECT_EQ(played.errand.wanted(), (std::vector<std::size_t>{0, 2}));
    EXPECT_EQ(played.errand.ended(), failure::too_early);
    EXPECT_EQ(played.brings(0), failure::goes_on);
    EXPECT_EQ(played.errand.brought(), (std::vector<Named>{{"apple", "red"}}));
    EXPECT_FALSE(played.errand.on_table(0));
    EXPECT_EQ(played.moves({{3, {.5, -.2}}}), failure::goes_on) << "a step that brings nothing";
    EXPECT_EQ(played.brings(2), failure::goes_on);
    EXPECT_EQ(played.errand.ended(), failure::none);
    EXPECT_EQ(played.brings(1), failure::went_on);
  }
  EXPECT_EQ(Played(two).brings(1), failure::not_wanted) << "alone of its colour";
  EXPECT_EQ(Played(two).moves({{0, Played::goal}, {3, Played::goal}}), failure::knocked_on);
  EXPECT_EQ(Played(two).moves({{3, Played::goal}}, false), failure::knocked_on);
  EXPECT_EQ(Played(two).moves({{2, Played::away}}), failure::lost_wanted);
  {
    Played played(two);
    EXPECT_EQ(played.moves({{0, Played::goal}, {2, Played::goal}}), failure::goes_on) << "both were wanted in turn";
    EXPECT_EQ(played.errand.ended(), failure::none);
  }
  {
    Played played(two);
    EXPECT_EQ(played.moves({{3, Played::away}}), failure::goes_on) << "nobody misses it";
    EXPECT_FALSE(played.errand.on_table(3));
  }
  Motion falls;
  falls.came_to_rest = false;
  Played played(two);
  EXPECT_EQ(played.errand.moved(played.poses, falls), failure::truncated);
}

TEST(Errand, WhatComesLaterStandsThereAfterTheFirstTake) {
  Scene scene = table(fruit(std::nullopt, {}, {}), {"red apple", "blue pear", "red lemon"});
  scene.objects[2].role = role::later;
  Played played(scene);
  EXPECT_EQ(played.errand.wanted(), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(played.moves({{0, {.4, -.3}}}), failure::goes_on);
  EXPECT_FALSE(played.errand.on_table(2)) << "nothing was brought yet";
  EXPECT_EQ(played.brings(0), failure::goes_on);
  EXPECT_EQ(played.errand.wanted(), (std::vector<std::size_t>{1, 2}));
}

std::vector<Named> names_at_first(const Scene& scene) {
  std::vector<Named> names;
  for (const SceneObject& o : scene.objects)
    if (o.role != role::goal && o.role != role::later) names.push_back({o.object_type, o.texture});
  return names;
}

// So many takes as somebody needs who always takes the first that is wanted.
int takes_of(const Meaning& meaning, std::vector<Named> things) {
  std::vector<Named> brought;
  while (!is_done(meaning, things, brought)) {
    const std::vector<Named> next = wanted(meaning, things, brought);
    if (next.empty()) return -1;
    things.erase(std::find(things.begin(), things.end(), next.front()));
    brought.push_back(next.front());
  }
  return static_cast<int>(brought.size());
}

class Errands : public testing::TestWithParam<std::string> {
 protected:
  const Scenario scenario = load_scenario(GetParam());
};

class ErrandsTold : public Errands {};

TEST_P(ErrandsTold, ScenesOfAPairDifferInCommandAndJudgeAlone) {
  for (const Arm& arm : scenario.tests) {
    const Perception perception = perception_of(scenario, arm, std::nullopt);
    EXPECT_EQ(perception != nullptr, arm.id == "read");
    for (int k = 0; k < 4; ++k) {
      const Scene one = sample_scene(scenario, request(arm.id), 2 * k),
                  other = sample_scene(scenario, request(arm.id), 2 * k + 1);
      EXPECT_NE(one.command, other.command);
      EXPECT_FALSE(*one.errand == *other.errand);
      EXPECT_NE(one.hash(), other.hash());
      EXPECT_EQ(one.shared_hash(), other.shared_hash()) << "places, names and ids, and what rows draw from it";
      EXPECT_EQ(one.drawn_as(), k);
      EXPECT_EQ(other.drawn_as(), k);
      const Observation seen = drawn(one), seen_by_other = drawn(other);
      EXPECT_EQ(seen.rgb, seen_by_other.rgb);
      EXPECT_EQ(seen.ids, seen_by_other.ids);
      ASSERT_EQ(seen.instances.size(), 8u) << "seven objects and the pallet; what comes later is not there yet";
      std::set<int> ids;
      for (const Instance& instance : seen.instances) ids.insert(instance.id);
      EXPECT_EQ(*ids.rbegin(), 8) << "no gap tells that something comes";
      for (int step = 0; perception && step < 3; ++step) {
        const Observation read = perception(seen, one, step), read_by_other = perception(seen, other, step);
        for (std::size_t i = 0; i < read.instances.size(); ++i) {
          EXPECT_EQ(read.instances[i].object_type, read_by_other.instances[i].object_type);
          EXPECT_EQ(read.instances[i].texture, read_by_other.instances[i].texture);
        }
      }
    }
  }
}

TEST_P(Errands, EveryCommandNeedsAsManyTakesAsTheFileSays) {
  const bool is_shown = scenario.commands.size() == 1;
  for (const Arm& arm : scenario.tests) {
    Json needed;
    for (const Json& test : scenario.json.at("tests"))
      if (test.at("arm") == arm.id) needed = test.at("needed");
    for (int i = 0; i < 8; ++i) {
      const Scene scene = sample_scene(scenario, request(arm.id), i);
      const Json& of_pair = needed.at(static_cast<std::size_t>(scene.drawn_as()) % needed.size());
      const bool is_second = is_shown ? scenario.id.back() == '2' : i % 2 == 1;
      EXPECT_EQ(takes_of(*scene.errand, names_at_first(scene)), of_pair.at(is_second ? 1 : 0)) << arm.id << i;
      EXPECT_EQ(scene.objects.size(), arm.id == "appears" ? 9u : 8u);
    }
  }
}

TEST_P(Errands, SomebodyTakesSomethingInEveryDemonstration) {
  for (int i = 0; i < 2 * static_cast<int>(scenario.commands_of("train").size()); ++i) {
    const Scene scene = sample_scene(scenario, request("train"), i);
    EXPECT_FALSE(scene.pair);
    EXPECT_GT(takes_of(*scene.errand, names_at_first(scene)), 0);
    EXPECT_EQ(scene.objects.size(), 6u);
    EXPECT_NE(scene.find(role::target), nullptr);
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, Errands, testing::ValuesIn(errands(false)));
INSTANTIATE_TEST_SUITE_P(Shipped, ErrandsTold, testing::ValuesIn(errands(true)));

TEST(ErrandScenes, ShownScenariosShareTheScenesOfTheirPair) {
  const Scenario told = load_scenario("errands_fruit"), one = load_scenario("errands_fruit_shown_1"),
                 other = load_scenario("errands_fruit_shown_2");
  for (int k = 0; k < 3; ++k) {
    const Scene first = sample_scene(one, request("shown"), k), second = sample_scene(other, request("shown"), k);
    EXPECT_EQ(drawn(first).rgb, drawn(second).rgb);
    EXPECT_EQ(drawn(first).rgb, drawn(sample_scene(told, request("told"), 2 * k)).rgb);
    EXPECT_EQ(first.shared_hash(), second.shared_hash());
    EXPECT_FALSE(*first.errand == *second.errand);
  }
}

std::string refused(const Json& members, const char* of = "errands_fruit") {
  Json json = load_scenario(of).json;
  json.merge_patch(members);
  try {
    read_scenario(json, "file");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(ErrandScenes, BadFilesAreRefusedWithTheirPlace) {
  const auto arm = [](Json members) {
    members.update({{"arm", "told"}, {"unseen", true}});
    return Json{{"tests", Json::array({std::move(members)})}};
  };
  EXPECT_EQ(refused(arm({{"needed", {{3, 1}, {7, 1}}}})),
            "file: /tests/0/needed/1/0: expected a whole number from 0 to 5, got 7");
  EXPECT_NE(refused(arm({{"needed", Json::array()}})), "");
  EXPECT_NE(refused(arm({})), "");
  EXPECT_NE(refused(arm({{"needed", {{3, 1}}}, {"hard", true}})), "");
  EXPECT_NE(refused({{"may_stop", nullptr}}), "");
  EXPECT_NE(refused({{"words", Json::object()}}), "");
  EXPECT_NE(refused({{"classes", Json::array()}}), "");
  EXPECT_NE(refused({{"pair", Json::array()}}), "");
  EXPECT_NE(refused({{"pair", Json::array()}}, "errands_fruit_shown_1"), "");
  const Json heart{{"object_types", {"heart"}}, {"textures", "ALL"}};
  EXPECT_NE(refused({{"commands", {{{"utterance", "Bring me a heart."}, {"truth", {{"target", heart}}}}}}},
                    "errands_fruit_shown_1"),
            "");
}

TEST(ErrandScenes, TakesThatNoSceneNeedsAreSaidInALineWhenScenesAreDrawn) {
  Json json = load_scenario("errands_fruit").json;
  json["tests"] = {{{"arm", "told"}, {"unseen", true}, {"needed", {{1, 3}}}}};
  const Scenario scenario = read_scenario(json, "file");
  EXPECT_EQ(
      message_of<InputError>([&] { sample_scene(scenario, request("told"), 0); }),
      "scenario \"errands_fruit\", arm told: expected a scene that shows how \"Bring me all the fruit.\" is meant");
}

std::vector<TestScene> tests_of(const Scenario& scenario, const std::string& arm, int n) {
  std::vector<TestScene> all;
  for (int i = 0; i < n; ++i)
    all.push_back(in_its_arm(scenario, test_scene(scenario, "continuous", arm, 7, i), std::nullopt));
  return all;
}

TEST(ErrandEpisodes, TheOracleEndsEveryOneRight) {
  for (const char* id : {"errands_fruit", "errands_letters", "errands_vowels"}) {
    const Scenario scenario = load_scenario(id);
    const auto environment = make_environment(scenario, make_engine());
    for (const Arm& arm : scenario.tests)
      for (const Episode& e :
           evaluate(*environment, tests_of(scenario, arm.id, 4), reference_actor("oracle"), [](int) {}))
        EXPECT_TRUE(e.success()) << id << " " << arm.id << " " << e.index << ": " << e.failure;
  }
}

TEST(ErrandEpisodes, WhatWasBroughtIsGoneAndKeepsTheNameThatWasRead) {
  const Scenario scenario = load_scenario("errands_fruit");
  const auto environment = make_environment(scenario, make_engine());
  int misread = 0;
  Observation last;
  Actor actor = reference_actor("oracle");
  actor.choose = [&, oracle = actor.choose](const Environment& at, const Given& given) {
    if (given.step > 0) {
      EXPECT_EQ(given.seen.brought.size(), static_cast<std::size_t>(given.step));
      EXPECT_EQ(given.seen.instances.size() + 1, last.instances.size());
      std::vector<Named> gone;
      for (const Instance& one : last.instances)
        if (std::none_of(given.seen.instances.begin(), given.seen.instances.end(),
                         [&](const Instance& o) { return o.id == one.id; }))
          gone.push_back({one.object_type, one.texture});
      EXPECT_EQ(gone, (std::vector<Named>{given.seen.brought.back()}));
      for (const SceneObject& o : given.scene.objects)
        misread += std::none_of(given.seen.instances.begin(), given.seen.instances.end(),
                                [&](const Instance& i) { return i.id == o.instance_id; }) &&
                   !(Named{o.object_type, o.texture} == given.seen.brought.back());
    } else {
      EXPECT_TRUE(given.seen.brought.empty());
    }
    last = given.seen;
    return oracle(at, given);
  };
  evaluate(*environment, tests_of(scenario, "read", 12), actor, [](int) {});
  EXPECT_GT(misread, 0);
}

TEST(ErrandEpisodes, TheSameStepsGiveTheSameBytes) {
  const Scenario scenario = load_scenario("errands_fruit");
  const auto environment = make_environment(scenario, make_engine());
  const Scene scene = test_scene(scenario, "continuous", "appears", 7, 0);
  std::vector<Observation> first;
  for (int time = 0; time < 2; ++time) {
    Observation seen = environment->reset(scene);
    EXPECT_EQ(seen.rgb, drawn(scene).rgb);
    for (std::size_t step = 0;; ++step) {
      if (time == 0) first.push_back(seen);
      EXPECT_EQ(seen.rgb, first.at(step).rgb);
      EXPECT_EQ(seen.brought, first.at(step).brought);
      EXPECT_EQ(seen.instances.size(), step == 0 ? 8u : 9u - step) << "one more came after the first take";
      StepResult result = environment->step(environment->expert_action());
      if (result.terminated) break;
      seen = std::move(result.observation);
    }
  }
}

TEST(ErrandEpisodes, WhoStopsAtOnceIsTooEarlyAndWhoNeverDoesRunsOut) {
  const Scenario scenario = load_scenario("errands_fruit");
  const auto environment = make_environment(scenario, make_engine());
  Actor stops;
  stops.choose = [](const Environment&, const Given&) { return Move(Action()); };
  for (const Episode& e : evaluate(*environment, tests_of(scenario, "told", 4), stops, [](int) {}))
    EXPECT_EQ(e.failure, failure::too_early);
  Actor misses;
  misses.choose = [](const Environment&, const Given&) { return Move(TwoPoses({{.3, .49}, {}}, {{.3, .49}, {}})); };
  for (const Episode& e : evaluate(*environment, tests_of(scenario, "told", 2), misses, [](int) {})) {
    EXPECT_EQ(e.failure, failure::goes_on);
    EXPECT_EQ(e.actions().size(), 6u);
  }
}

}  // namespace
}  // namespace lgabench::tabletop
