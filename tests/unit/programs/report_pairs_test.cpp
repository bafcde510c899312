// Two commands on one scene, both right: numbers computed by hand.
#include <gtest/gtest.h>

#include <lgabench/statistics/paired.hpp>

#include "../testing.hpp"

namespace lgabench {
namespace {

using statistics::CellResult;
using statistics::Cells;

Episode episode(int index, const std::string& pair, bool won, std::optional<Progress> progress, bool done) {
  Episode e;
  e.arm = "told";
  e.index = index;
  e.scene = std::to_string(index);
  e.pair = pair;
  e.failure = won ? failure::none : "wrong";
  e.progress = progress;
  e.done = done;
  return e;
}

CellResult cell(const std::string& scenario, int seed) {
  CellResult one;
  one.scenario = scenario;
  one.training_seed = seed;
  return one;
}

// Four scenes of a pair, of which both commands end right in one, and a scene of which one command was given alone.
CellResult told() {
  CellResult one = cell("fruit", 0);
  one.episodes["told"] = {episode(0, "a", true, Progress{3, 3}, true),   episode(1, "a", true, Progress{1, 1}, true),
                          episode(2, "b", true, Progress{2, 2}, true),   episode(3, "b", false, Progress{1, 4}, true),
                          episode(4, "c", false, Progress{2, 3}, false), episode(5, "c", false, Progress{0, 1}, false),
                          episode(6, "d", false, Progress{0, 2}, false), episode(7, "d", false, std::nullopt, false),
                          episode(8, "e", true, Progress{2, 2}, true)};
  return one;
}

TEST(Pairs, AreWonWhereBothCommandsEndRight) {
  const CellResult one = told();
  const auto paired = statistics::paired_success({&one}, "told", "test");
  ASSERT_TRUE(paired);
  EXPECT_DOUBLE_EQ(paired->share, .25);
  EXPECT_EQ(paired->scenes, 4) << "the scene with one command is left out";
  const statistics::Interval by_hand = statistics::wilson(1, 4);
  EXPECT_DOUBLE_EQ(paired->interval.low, by_hand.low);
  EXPECT_DOUBLE_EQ(paired->interval.high, by_hand.high);
  EXPECT_FALSE(paired->over_commands) << "one pair of commands says nothing of others";
  EXPECT_FALSE(statistics::paired_success({&one}, "seen", "test"));
}

TEST(Pairs, JoinTwoScenariosThatShareScenes) {
  CellResult one = cell("fruit_1", 0), other = cell("fruit_2", 0), later = cell("fruit_2", 1);
  one.episodes["shown"] = {episode(0, "a", true, {}, true), episode(1, "b", true, {}, true)};
  other.episodes["shown"] = {episode(0, "a", true, {}, true), episode(1, "b", false, {}, true)};
  later.episodes["shown"] = other.episodes["shown"];
  const auto paired = statistics::paired_success({&other, &one, &later}, "shown", "test");
  ASSERT_TRUE(paired);
  ASSERT_EQ(paired->by_commands.size(), 1u);
  EXPECT_EQ(paired->by_commands[0].first, "fruit_1 + fruit_2");
  EXPECT_DOUBLE_EQ(paired->share, .5) << "another training seed's episodes are no pair's";
  EXPECT_FALSE(statistics::paired_success({&one}, "shown", "test")) << "half of a pair";
}

TEST(Pairs, OfSixCommandsSaySomethingOfOthersAndOfFiveNothing) {
  std::vector<CellResult> all;
  for (int i = 0; i < 6; ++i) {
    all.push_back(told());
    all.back().scenario += std::to_string(i);
    for (Episode& e : all.back().episodes["told"]) e.pair += std::to_string(i);
  }
  Cells cells;
  for (const CellResult& one : all) cells.push_back(&one);
  const auto six = statistics::paired_success(cells, "told", "test");
  ASSERT_TRUE(six && six->over_commands);
  EXPECT_LE(six->over_commands->low, six->interval.low);
  EXPECT_GE(six->over_commands->high, six->interval.high);
  cells.pop_back();
  EXPECT_FALSE(statistics::paired_success(cells, "told", "test")->over_commands);
}

TEST(Pairs, TellHowFarEpisodesCame) {
  const CellResult one = told();
  const auto course = statistics::course_of({&one}, "told", "test");
  ASSERT_TRUE(course);
  EXPECT_EQ(course->too_early, 1);
  EXPECT_EQ(course->went_on, 2) << "one of them where nothing was to be taken";
  EXPECT_NEAR(course->progress, (1 + 1 + 1 + .25 + 2. / 3 + 0 + 0 + 0 + 1) / 9, 1e-12);
  ASSERT_TRUE(course->first_take && course->refusals && course->takings);
  EXPECT_NEAR(course->first_take->share, 5. / 7, 1e-12);
  EXPECT_NEAR(course->refusals->share, 1. / 2, 1e-12);
  EXPECT_NEAR(course->takings->share, 3. / 7, 1e-12);
  CellResult flat = told();
  for (Episode& e : flat.episodes["told"]) e.progress.reset();
  EXPECT_FALSE(statistics::course_of({&flat}, "told", "test"));
}

TEST(Pairs, OfTwoRowsAreComparedPairByPair) {
  const CellResult lost = told();
  CellResult won = told();
  for (Episode& e : won.episodes["told"]) e.failure = failure::none;
  const auto row = statistics::both_on_pairs({{{0, ""}, {{&lost}, {&won}}}}, "told");
  EXPECT_EQ(row.policies(), 1);
  EXPECT_DOUBLE_EQ(row.change("test").difference, .75);
  EXPECT_EQ(row.total().only_second, 3);
}

}  // namespace
}  // namespace lgabench
