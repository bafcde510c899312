// The tabletop over an engine: failures are typed, and an episode depends on its scene alone.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <common/objects.hpp>
#include <lgabench/core/error.hpp>
#include <tabletop/judge.hpp>
#include <tabletop/oracle.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/task.hpp>

#include "../tabletop_bench.hpp"

namespace lgabench::tabletop {
namespace {

// 0: distractor (id 1), 1: the pallet (id 2), 2: target (id 3).
Scene bring(const std::string& type = "heart") {
  Scene scene;
  scene.task = "pick_and_place";
  scene.objects = {object("block", "blue", role::distractor, {.4, -.35}, 1),
                   object("pallet", "wooden", role::goal, {.5, .3}, 2),
                   object(type, "red", role::target, {.6, -.05}, 3)};
  return scene;
}

TEST(Tabletop, TheOracleCarriesEveryTypeFromEveryYawOntoTheGoal) {
  const Bench household = make_bench("household");
  for (const std::string& type : object_types())
    for (const double yaw : {0.0, 2.0, -1.2}) {
      Scene scene = bring(type);
      scene.objects[2].yaw_rad = yaw;
      const Episode episode = play(*household.environment, scene);
      EXPECT_TRUE(episode.result.is_success) << type << ": " << episode.result.failure;
      const Pose reached = household.world->pose(2);
      EXPECT_LT(norm(centre_of(scene.objects[2], reached) - Vec2{.5, .3}), .03) << type << " at yaw " << yaw;
      EXPECT_NEAR(yaw_of(episode.action.pose1.rotation), 0, 1e-12);
    }
}

TEST(Tabletop, TheOracleTurnsTheTargetInPlace) {
  for (const std::string type : {"block", "bowl", "L-shaped block", "letter G"})
    for (const double degrees : {120.0, 135.0, -90.0}) {
      Scene scene = bring(type);
      scene.task = "rotate";
      set_asked_turn(scene, degrees * pi / 180);
      scene.objects.erase(scene.objects.begin() + 1);
      const StepResult result = play(environment(), scene).result;
      EXPECT_TRUE(result.is_success) << type << " by " << degrees << ": " << result.failure;
    }
}

TEST(Tabletop, ANumberThatIsNotOneIsTheMethodsFault) {
  const Observation before = environment().reset(bring());
  TwoPoses action = environment().expert_action();
  action.pose1.position_m.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(environment().step(action), MethodError);
  action = environment().expert_action();
  action.pose0.rotation = {0, 0, 0, 0};
  EXPECT_THROW(environment().step(action), MethodError);
  EXPECT_EQ(bench().world->steps, 0);
  EXPECT_TRUE(environment().step(environment().expert_action()).is_success);
}

TEST(Tabletop, WhereNothingIsTakenNothingMoves) {
  const Vec2 empty{.3, .1}, on_pallet{.5, .3};
  for (const Vec2 point : {empty, on_pallet}) {
    const Observation before = environment().reset(bring());
    const StepResult result = environment().step(from_to(point, {.5, 0}));
    EXPECT_EQ(result.failure, "missed_object");
    EXPECT_FALSE(result.is_success);
    EXPECT_TRUE(result.terminated);
    EXPECT_EQ(result.observation.rgb, before.rgb);
    EXPECT_EQ(result.observation.ids, before.ids);
  }
}

TEST(Tabletop, TheSuctionDiscReachesAHundredthAroundItsCentre) {
  const double edge = .4 - .035;  // of the distractor, in x
  environment().reset(bring());
  EXPECT_EQ(environment().step(from_to({edge - .0115, -.35}, {.4, .1})).failure, "missed_object");
  environment().reset(bring());
  EXPECT_EQ(environment().step(from_to({edge - .009, -.35}, {.4, .1})).failure, "wrong_object");
}

TEST(Tabletop, TakingADistractorIsTheWrongObject) {
  environment().reset(bring());
  const StepResult result = environment().step(environment().expert_action_for(1));
  EXPECT_EQ(result.failure, "wrong_object");
  EXPECT_LT(norm(centre_of(bring().objects[0], bench().world->pose(0)) - Vec2{.5, .3}), .03);
}

TEST(Tabletop, PlacingBesideTheGoalIsABadPlacement) {
  environment().reset(bring("block"));
  TwoPoses action = environment().expert_action();
  action.pose1.position_m.y -= .13;
  EXPECT_EQ(environment().step(action).failure, "bad_placement");
  environment().reset(bring("block"));
  action.pose1.position_m.y += .05;  // .08 from the goal's centre
  EXPECT_EQ(environment().step(action).failure, failure::none);
}

TEST(Tabletop, TurnsByTheSecondPosesYaw) {
  environment().reset(bring("L-shaped block"));
  TwoPoses action = environment().expert_action();
  action.pose1 = {{.5, .05}, from_yaw(2.5)};
  environment().step(action);
  EXPECT_NEAR(yaw_of(bench().world->pose(2).rotation), 2.5, .02);
  EXPECT_NEAR(bench().world->pose(2).position_m.z, 0, 1e-3);
}

TEST(Tabletop, PositionsOutsideAreCarriedOutAtTheBorder) {
  environment().reset(bring());
  TwoPoses action = environment().expert_action();
  action.pose1.position_m = {9, -9};
  environment().step(action);
  const Vec2 reached = centre_of(bring().objects[2], bench().world->pose(2));
  EXPECT_LT(norm(reached - Vec2{Workspace::x_max, Workspace::y_min}), .1);
}

TEST(Tabletop, ASecondActionStartsFromTheStateReached) {
  environment().reset(bring());
  EXPECT_EQ(environment().step(from_to({.3, .1}, {.5, .3})).failure, "missed_object");
  EXPECT_TRUE(environment().step(environment().expert_action()).is_success);

  environment().reset(bring());
  TwoPoses wide = environment().expert_action();
  wide.pose1 = {{.4, .1}, from_yaw(1)};
  EXPECT_EQ(environment().step(wide).failure, "bad_placement");
  const TwoPoses again = environment().expert_action();
  EXPECT_LT(norm(again.pose0.position_m - Vec2{.4, .1}), .01);  // where suction let go of it
  EXPECT_TRUE(environment().step(again).is_success);
}

TEST(Tabletop, TheOracleRecoversFromWhateverANoisyActionLeaves) {
  const Scenario scenario = load_scenario("something_from_a_typical_kitchen");
  int recovered = 0, played = 0;
  for (int i = 0; i < 40; ++i) {
    const Scene scene = sample_scene(scenario, {"cells", "train", "train", 9}, i);
    environment().reset(scene);
    TwoPoses noisy = environment().expert_action();
    noisy.pose1.position_m = noisy.pose1.position_m + Vec2{.05 * std::sin(i), .2 * std::cos(2 * i)};
    noisy.pose1.rotation = from_yaw(i);
    if (environment().step(noisy).failure == "left_workspace") continue;
    ++played;
    recovered += environment().step(environment().expert_action()).is_success;
  }
  EXPECT_GT(played, 20);
  EXPECT_EQ(recovered, played);
}

TEST(Tabletop, RefusesSceneryItDoesNotKnow) {
  EXPECT_THROW(environment().reset(bring("unicorn")), InputError);
  Scene scene = bring();
  scene.objects[2].texture = "invisible";
  EXPECT_THROW(environment().reset(scene), InputError);
  scene = bring();
  scene.objects[1].object_type = "bowl";  // only a pallet is a goal
  EXPECT_THROW(environment().reset(scene), InputError);
  environment().reset(bring());
  EXPECT_THROW(environment().expert_action_for(77), InputError);
  EXPECT_THROW(make_bench().environment->expert_action(), InputError);
}

TEST(Tabletop, AnObservationCarriesTheScenesIdsAndNoMore) {
  const Observation o = environment().reset(bring());
  ASSERT_EQ(o.instances.size(), 3u);
  EXPECT_EQ(o.instances[2].id, 3);
  EXPECT_EQ(o.instances[2].object_type, "heart");
  const StepResult after = environment().step(environment().expert_action());
  ASSERT_EQ(after.observation.instances.size(), 3u);
  EXPECT_NE(after.observation.ids, o.ids);
}

}  // namespace
}  // namespace lgabench::tabletop
