// Episodes of the mobile environment: what a plan leads to.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include <mobile/drive.hpp>
#include <mobile/judge.hpp>
#include <mobile/mobile.hpp>
#include <mobile/plan.hpp>
#include <mobile/renderer.hpp>

#include "../engine_under_test.hpp"
#include "mobile_scenes.hpp"

namespace lgabench::mobile {
namespace {

const char* const ids[] = {"bring_fruit", "throw_away_drink"};

Environment& environment() {
  static const auto made = make_environment(make_engine());
  return *made;
}

// A scene with a distractor, its oracle's plan, and what a changed plan fails with.
Failure failure_of(const std::string& id, const std::function<void(Plan&)>& change) {
  for (int i = 0;; ++i) {
    const Scene scene = test_scene(id, "moved", i);
    if (!scene.find(role::distractor)) continue;
    environment().reset(scene);
    Plan plan = environment().expert_action();
    change(plan);
    return environment().step(plan).failure;
  }
}

TEST(MobileEpisode, FailsAsThePlanDoes) {
  for (const char* id : ids) {
    EXPECT_EQ(failure_of(id, [](Plan&) {}), failure::none);
    EXPECT_EQ(failure_of(id, [](Plan& p) { p.u = 0, p.v = 1; }), failure::missed_object) << "the floor";
    EXPECT_EQ(failure_of(id, [](Plan& p) { p.u = .016, p.v = 350. / 480; }), failure::missed_object)
        << "the table's top";
    EXPECT_EQ(failure_of(id, [](Plan& p) { p.u = .016, p.v = 362. / 480; }), failure::wrong_object) << "its front";
    EXPECT_EQ(failure_of(id, [](Plan& p) { p.waypoint_m = {2, 0}; }), failure::blocked_way) << "through the table";
    EXPECT_EQ(failure_of(id, [](Plan& p) { p.cosine = -p.cosine, p.sine = -p.sine; }), failure::out_of_reach);
    EXPECT_EQ(failure_of(id, [](Plan& p) { p.waypoint_m = {}; }), failure::out_of_reach);
    EXPECT_EQ(failure_of(id,
                         [](Plan& p) {
                           p.waypoint_m = {-.39, 1.16};
                           p.cosine = 0, p.sine = 1;
                           p.drop_m = {-.333, 2.09};
                         }),
              failure::blocked_way)
        << "into the person, where MuJoCo's accelerations had no bound";
    EXPECT_EQ(failure_of(id,
                         [](Plan& p) {
                           p.drop_m = p.waypoint_m + .3 * Vec2{p.cosine, p.sine};
                         }),
              failure::dropped_elsewhere);
  }
  const Scene scene = test_scene("bring_fruit", "moved", 1);
  environment().reset(scene);
  const Action wrong = environment().expert_action_for(scene.find(role::distractor)->instance_id);
  const StepResult result = environment().step(wrong);
  EXPECT_EQ(result.failure, failure::wrong_object);
  EXPECT_TRUE(result.recoverable);
  EXPECT_TRUE(environment().step(environment().expert_action()).is_success) << "nothing has moved";
}

TEST(MobileEpisode, SaysHowFarEachPartIsFromSuccess) {
  const Scene scene = test_scene("bring_fruit", "moved", 1);
  const auto after = [&](const std::function<void(Plan&)>& change) {
    environment().reset(scene);
    Plan plan = environment().expert_action();
    change(plan);
    const StepResult result = environment().step(plan);
    std::map<std::string, double> parts;
    for (const Gap& gap : result.gaps) parts[gap.part] = gap.value;
    const bool all_zero = std::all_of(parts.begin(), parts.end(), [](const auto& gap) { return gap.second == 0; });
    EXPECT_EQ(all_zero, result.is_success) << result.failure;
    EXPECT_EQ(parts.size(), 5U);
    return parts;
  };
  EXPECT_EQ(after([](Plan&) {})["place_m"], 0);
  const double far_px = after([](Plan& p) { p.u = 0, p.v = 1; })["reach_px"];
  EXPECT_GT(far_px, 100);
  EXPECT_LT(after([](Plan& p) { p.v = std::min(1., p.v + .2); })["reach_px"], far_px);
  EXPECT_EQ(after([](Plan& p) { p.u = 0, p.v = 1; })["pick"], 1);
  EXPECT_EQ(after([](Plan& p) { p.waypoint_m = {2, 0}; })["drive"], 1);
  const auto dropped = after([](Plan& p) { p.drop_m = p.waypoint_m + .3 * Vec2{p.cosine, p.sine}; });
  EXPECT_GT(dropped.at("place_m"), .2);
  EXPECT_EQ(dropped.at("pick") + dropped.at("drive") + dropped.at("reach_px"), 0);
}

TEST(MobileEpisode, RefusesAPlanThatIsNone) {
  environment().reset(test_scene("bring_fruit", "moved", 0));
  Plan plan = environment().expert_action();
  plan.cosine = plan.sine = 0;
  EXPECT_THROW(environment().step(plan), MethodError);
  plan = environment().expert_action();
  plan.u = std::nan("");
  EXPECT_THROW(environment().step(plan), MethodError);
  EXPECT_THROW(environment().step(Action(12)), MethodError);
}

TEST(MobileEpisode, DependsOnItsSceneAlone) {
  const auto play = [](int i) {
    environment().reset(test_scene(ids[i % 2], "crowd", i));
    return environment().step(environment().expert_action());
  };
  std::vector<StepResult> first;
  for (int i = 0; i < 6; ++i) first.push_back(play(i));
  for (int i = 5; i >= 0; --i) {
    const StepResult again = play(i);
    EXPECT_EQ(again.failure, first[static_cast<std::size_t>(i)].failure);
    EXPECT_EQ(again.observation.rgb, first[static_cast<std::size_t>(i)].observation.rgb);
  }
}

TEST(MobileEpisode, TheFirstDemonstrationRepeatedSeldomSucceedsInSamePlace) {
  for (const char* id : ids) {
    int successes = 0, played = 0;
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      environment().reset(sample_scene(scenario(id), {layout, "train", "train", seed}, 0));
      const Action shown = environment().expert_action();
      for (int i = 0; i < 20; ++i, ++played) {
        environment().reset(test_scene(id, "same_place", i, seed));
        successes += environment().step(shown).is_success;
      }
    }
    EXPECT_LT(successes, .1 * played) << id;
  }
}

Vec2 waypoint_of(const std::string& task) {
  Scene scene;
  scene.task = task;
  return task_of(scene).waypoint_m;
}

TEST(MobilePlace, BlocksTheWayThroughThings) {
  EXPECT_FALSE(blocked({0, 0}));
  EXPECT_FALSE(blocked(waypoint_of("bring")));
  EXPECT_FALSE(blocked(waypoint_of("throw_away")));
  EXPECT_TRUE(blocked({.31, 0})) << "the table's edge, less the robot's radius";
  EXPECT_FALSE(blocked({.29, 0}));
  EXPECT_TRUE(blocked({2, .8})) << "behind the table";
  EXPECT_TRUE(blocked(person));
  EXPECT_TRUE(blocked(bin.centre));
  EXPECT_FALSE(blocked({-2, -2}));

  const Vec2 before_person = waypoint_of("bring");
  EXPECT_FALSE(meets_person(before_person, tray.centre));
  EXPECT_FALSE(meets_person(before_person, {tray.centre.x, tray.outer().high.y})) << "the tray's far edge";
  EXPECT_TRUE(meets_person(before_person, person));
  EXPECT_TRUE(meets_person({person.x, 2.6}, tray.centre)) << "from behind";
}

TEST(MobilePlace, ReachesAMeterAheadAndSixtyDegreesAside) {
  Plan plan;
  const auto reaches = [&](double away, double degrees) {
    plan.drop_m = plan.waypoint_m + rotated(Vec2{away, 0}, degrees * pi / 180);
    return within_reach(plan);
  };
  EXPECT_TRUE(reaches(.99, 0));
  EXPECT_FALSE(reaches(1.01, 0));
  EXPECT_TRUE(reaches(.5, 59));
  EXPECT_TRUE(reaches(.5, -59));
  EXPECT_FALSE(reaches(.5, 61));
  EXPECT_FALSE(reaches(.5, 180));
}

}  // namespace
}  // namespace lgabench::mobile
