// Sweep over an engine: where the oracle brings what it pushes, failures are typed, zones are seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <common/objects.hpp>
#include <tabletop/judge.hpp>
#include <tabletop/oracle.hpp>

#include "../tabletop_bench.hpp"

namespace lgabench::tabletop {
namespace {

// 0: distractor (id 1), 1: obstacle (id 2), 2: target (id 3); the right side, y > 0, is free.
Scene sweep(const std::string& type = "block", const std::string& obstacle = "pan") {
  Scene scene;
  scene.task = "sweep";
  scene.objects = {object("heart", "blue", role::distractor, {.625, .16}, 1),
                   object(obstacle, "green", "obstacle", {.375, -.16}, 2),
                   object(type, "red", role::target, {.375, .05}, 3)};
  scene.objects[1].yaw_rad = pi / 2;
  return scene;
}

TEST(Sweep, TheOracleBringsTheCentreToTheMiddleOfTheFreeZone) {
  for (const std::string type : {"block", "small block", "shorter block", "L-shaped block"}) {
    const Episode episode = play(environment(), sweep(type));
    EXPECT_TRUE(episode.result.is_success) << type << ": " << episode.result.failure;
    const Vec2 reached = centre_of(sweep(type).objects[2], bench().world->pose(2));
    EXPECT_NEAR(reached.y, .41, .03) << type;
    EXPECT_NEAR(reached.x, .375, .03) << type;
    EXPECT_NEAR(bench().world->pose(2).position_m.z, 0, 1e-3) << type << " has toppled";
    EXPECT_LT(norm(centre_of(sweep(type).objects[1], bench().world->pose(1)) - Vec2{.375, -.16}), 1e-6);
  }
}

TEST(Sweep, AUtensilInTheFreeWayIsPushedAlongAndStaysOnTheTable) {
  const Bench household = make_bench("household");
  for (const std::string type : {"block", "small block", "shorter block", "L-shaped block"})
    for (const std::string utensil : {"fork", "spoon", "knife"})
      for (const double side : {-1., 1.}) {
        Scene scene = sweep(type, "line");
        scene.objects[0] = object(utensil, "blue", role::distractor, {.375, .05 + side * .21}, 1);
        scene.objects[0].yaw_rad = pi / 2;
        scene.objects[1].position_m = {.375, .05 - side * .21};
        const StepResult result = play(*household.environment, scene).result;
        EXPECT_TRUE(result.is_success) << type << ", " << utensil << ", " << side << ": " << result.failure;
        const Vec2 reached = centre_of(scene.objects[0], household.world->pose(0));
        EXPECT_GT(std::abs(reached.y - .05), .22) << utensil << " was not pushed by the " << type;
      }
}

TEST(Sweep, FailuresAreTyped) {
  const auto outcome = [](const Scene& scene, Vec2 from, Vec2 to) {
    environment().reset(scene);
    return environment().step(from_to(from, to)).failure;
  };
  EXPECT_EQ(outcome(sweep(), {.375, -.03}, {.375, .2}), "missed_zone");
  EXPECT_EQ(outcome(sweep(), {.5, -.03}, {.5, .3}), "missed_object");
  EXPECT_EQ(outcome(sweep(), {.625, .05}, {.625, .37}), "wrong_object");
  EXPECT_EQ(outcome(sweep(), {.375, -.01}, {.375, .5}), "left_workspace");
  for (const std::string obstacle : {"pan", "line"}) {
    EXPECT_EQ(outcome(sweep("block", obstacle), {.375, .13}, {.375, -.15}), "touched_obstacle") << obstacle;
    EXPECT_EQ(outcome(sweep("block", obstacle), {.375, -.16}, {.375, .37}), "touched_obstacle")
        << obstacle << ": the spatula comes down on it";
    EXPECT_EQ(outcome(sweep("block", obstacle), {.375, .13}, {.375, .02}), "missed_zone") << obstacle;
  }
}

TEST(Sweep, ATouchIsRememberedAfterASecondAction) {
  environment().reset(sweep());
  EXPECT_EQ(environment().step(from_to({.375, -.16}, {.375, -.16})).failure, "touched_obstacle");
  EXPECT_EQ(environment().step(environment().expert_action()).failure, "touched_obstacle");
  environment().reset(sweep());
  EXPECT_EQ(environment().step(from_to({.375, -.03}, {.375, .1})).failure, "missed_zone");
  EXPECT_TRUE(environment().step(environment().expert_action()).is_success);
}

TEST(Sweep, ZonesAreSeenInTheColoursOnly) {
  Scene scene = sweep();
  const Observation zones = environment().reset(scene);
  scene.task = "rotate";
  const Observation plain = environment().reset(scene);
  EXPECT_EQ(zones.ids, plain.ids);
  EXPECT_EQ(zones.instances.size(), 3u);
  for (int column = 0; column < Workspace::columns; ++column) {
    const double y = (column + .5) / Workspace::columns - .5;
    const auto first = static_cast<std::ptrdiff_t>(3 * column);  // of row 0, which holds no object
    EXPECT_EQ(std::abs(y) >= .34 && std::abs(y) <= .48,
              !std::equal(zones.rgb.begin() + first, zones.rgb.begin() + first + 3, plain.rgb.begin() + first))
        << y;
  }
}

}  // namespace
}  // namespace lgabench::tabletop
