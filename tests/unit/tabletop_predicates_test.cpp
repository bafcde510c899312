// Success and failures at their boundaries, without physics.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <common/objects.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/random.hpp>
#include <tabletop/judge.hpp>
#include <tabletop/oracle.hpp>
#include <tabletop/task.hpp>
#include <tabletop/tasks/sweep.hpp>

namespace lgabench::tabletop {
namespace {

SceneObject object(const std::string& type, const Role& role, Vec2 position, std::uint8_t id) {
  SceneObject o;
  o.object_type = type;
  o.texture = "red";
  o.role = role;
  o.position_m = position;
  o.instance_id = id;
  return o;
}

// 0: distractor, 1: target, 2: the pallet.
Scene bring() {
  Scene scene;
  scene.task = "pick_and_place";
  scene.objects = {object("block", role::distractor, {.4, -.3}, 1), object("heart", role::target, {.6, -.1}, 2),
                   object("pallet", role::goal, {.5, .3}, 3)};
  return scene;
}

Scene turn(double degrees) {
  Scene scene;
  scene.task = "rotate";
  set_asked_turn(scene, degrees * pi / 180);
  scene.objects = {object("block", role::distractor, {.4, -.3}, 1), object("block", role::target, {.6, -.1}, 2)};
  scene.objects[1].yaw_rad = 1;
  return scene;
}

std::vector<Pose> start(const Scene& scene) {
  std::vector<Pose> poses;
  for (const SceneObject& o : scene.objects)
    poses.push_back({{o.position_m.x, o.position_m.y, 0}, from_yaw(o.yaw_rad)});
  return poses;
}

Failure judge_moved(const Scene& scene, std::size_t which, Vec2 to, double yaw, const Motion& motion) {
  auto poses = start(scene);
  poses[which] = {{to.x, to.y, 0}, from_yaw(yaw)};
  return judge(scene, poses, motion);
}

const Motion took_target{1, true}, took_distractor{0, true}, took_nothing{no_body, true};

TEST(PickAndPlace, SucceedsWithinTheRadiusOfTheGoal) {
  const Scene scene = bring();
  for (const double angle : {0.0, 1.0, 2.5, 4.0}) {
    const auto beside = [&](double r) { return Vec2{.5, .3} + rotated({r, 0}, angle); };
    EXPECT_EQ(judge_moved(scene, 1, beside(.0999), .7, took_target), failure::none);
    EXPECT_EQ(judge_moved(scene, 1, beside(.1001), .7, took_target), "bad_placement");
  }
}

TEST(PickAndPlace, ADistractorOnTheGoalSpoilsIt) {
  const Scene scene = bring();
  auto poses = start(scene);
  poses[1].position_m = {.5, .3, .035};
  poses[0].position_m = {.5, .3 - .0999, .035};
  EXPECT_EQ(judge(scene, poses, took_target), "bad_placement");
  poses[0].position_m = {.5, .3 - .1001, 0};
  EXPECT_EQ(judge(scene, poses, took_target), failure::none);
}

TEST(PickAndPlace, SaysWhatWentWrong) {
  const Scene scene = bring();
  EXPECT_EQ(judge(scene, start(scene), took_nothing), "missed_object");
  EXPECT_EQ(judge_moved(scene, 0, {.5, .3}, 0, took_distractor), "wrong_object");
  EXPECT_EQ(judge_moved(scene, 1, {.7, .3}, 0, took_target), "bad_placement");
  EXPECT_EQ(judge_moved(scene, 1, {.7, .51}, 0, took_target), "left_workspace");
  EXPECT_EQ(judge_moved(scene, 0, {.24, 0}, 0, took_distractor), "left_workspace");
  EXPECT_EQ(judge_moved(scene, 1, {.5, .3}, 0, {1, false}), failure::truncated);
}

TEST(PickAndPlace, IsJudgedByTheStateNotByTheLastMotion) {
  EXPECT_EQ(judge_moved(bring(), 1, {.5, .3}, 0, took_nothing), failure::none);
}

TEST(PickAndPlace, NeedsATargetAndAGoal) {
  Scene scene = bring();
  scene.objects[2].role = role::distractor;
  EXPECT_THROW(judge(scene, start(scene), took_target), InputError);
  scene = bring();
  scene.objects[1].role = role::distractor;
  EXPECT_THROW(judge(scene, start(scene), took_target), InputError);
}

TEST(PickAndPlace, ACentreIsTheMiddleAlsoOfAToppledObject) {
  const SceneObject block = object("block", role::target, {}, 1);
  const double height = object_model("block").height_m;
  const Pose on_its_side{{.5, .3, .035}, {0, std::sin(pi / 4), 0, std::cos(pi / 4)}};  // a quarter turn about y
  EXPECT_NEAR(centre_of(block, on_its_side).x, .5 + height / 2, 1e-12);
  EXPECT_NEAR(centre_of(block, on_its_side).y, .3, 1e-12);
}

// Paper, Q3: "a fruit" is right with the apple and with the tomato.
TEST(PickAndPlace, AnyOfSeveralTargetsIsRight) {
  Scene scene = bring();
  scene.objects.push_back(object("star", role::target, {.4, 0}, 4));
  const Motion took_star{3, true};
  EXPECT_EQ(judge_moved(scene, 1, {.5, .3}, 0, took_target), failure::none);
  EXPECT_EQ(judge_moved(scene, 3, {.5, .3}, 0, took_star), failure::none);
  EXPECT_EQ(judge_moved(scene, 3, {.7, .3}, 0, took_star), "bad_placement");
  EXPECT_EQ(judge_moved(scene, 0, {.5, .1}, 0, took_distractor), "wrong_object");
  EXPECT_EQ(judge(scene, start(scene), took_nothing), "missed_object");
}

TEST(Rotate, AnyOfSeveralTargetsIsRight) {
  Scene scene = turn(120);
  scene.objects.push_back(object("bowl", role::target, {.4, .2}, 3));
  const double turned = 120 * pi / 180;
  EXPECT_EQ(judge_moved(scene, 2, {.4, .2}, turned, {2, true}), failure::none);
  EXPECT_EQ(judge_moved(scene, 1, {.6, -.1}, 1 + turned, took_target), failure::none);
  EXPECT_EQ(judge_moved(scene, 2, {.4, .2}, turned + 1, {2, true}), "bad_angle");
  EXPECT_EQ(judge_moved(scene, 2, {.4, .35}, turned, {2, true}), "bad_placement");
}

TEST(Rotate, SucceedsWithin15DegreesOfTheTrueAngle) {
  for (const double degrees : {120.0, 135.0, -120.0, 180.0}) {
    const Scene scene = turn(degrees);
    const auto after = [&](double d) { return judge_moved(scene, 1, {.6, -.1}, 1 + d * pi / 180, took_target); };
    EXPECT_EQ(after(degrees), failure::none);
    EXPECT_EQ(after(degrees + 14.9), failure::none);
    EXPECT_EQ(after(degrees - 14.9), failure::none);
    EXPECT_EQ(after(degrees + 15.1), "bad_angle");
    EXPECT_EQ(after(degrees - 15.1), "bad_angle");
    EXPECT_EQ(after(degrees - 90), "bad_angle") << "a square block's symmetry does not count";
    EXPECT_EQ(after(0), "bad_angle");
  }
}

TEST(Rotate, TheTargetStaysAndDistractorsAreNotDisturbed) {
  const Scene scene = turn(120);
  const double yaw = 1 + 120 * pi / 180;
  EXPECT_EQ(judge_moved(scene, 1, {.6, -.1 + .0999}, yaw, took_target), failure::none);
  EXPECT_EQ(judge_moved(scene, 1, {.6, -.1 + .1001}, yaw, took_target), "bad_placement");
  auto poses = start(scene);
  poses[1].rotation = from_yaw(yaw);
  poses[0].position_m.x += .0199;
  EXPECT_EQ(judge(scene, poses, took_target), failure::none);
  poses[0].position_m.x += .0002;
  EXPECT_EQ(judge(scene, poses, took_target), "bad_placement");
}

TEST(OtherLimits, NarrowerOnesTakeSuccessAwayAndWiderOnesGiveIt) {
  const auto brought = [](double off, const JudgeLimits& limits) {
    const Scene scene = bring();
    auto poses = start(scene);
    poses[1].position_m = {.5, .3 + off, 0};
    EXPECT_NEAR(off_m(scene, poses), off, 1e-12);
    return judge(scene, poses, took_target, limits);
  };
  EXPECT_EQ(brought(.07, {}), failure::none);
  EXPECT_EQ(brought(.07, {.06}), "bad_placement");
  EXPECT_EQ(brought(.15, {.16}), failure::none);
  Scene scene = bring();
  auto poses = start(scene);
  poses[1].position_m = {.5, .3, 0};
  poses[0].position_m = {.5, .3 - .0999, 0};
  EXPECT_EQ(judge(scene, poses, took_target, {.01}), "bad_placement")
      << "a distractor on the goal spoils it all the same";

  scene = turn(120);
  poses = start(scene);
  poses[1] = {{.6, -.04, 0}, from_yaw(1 + 130 * pi / 180)};
  EXPECT_NEAR(off_m(scene, poses), .06, 1e-12);
  EXPECT_EQ(judge(scene, poses, took_target), failure::none);
  EXPECT_EQ(judge(scene, poses, took_target, {.05}), "bad_placement");
  EXPECT_EQ(judge(scene, poses, took_target, {{}, 9}), "bad_angle");
  poses[1].rotation = from_yaw(1 + 150 * pi / 180);
  EXPECT_EQ(judge(scene, poses, took_target, {{}, 31}), failure::none);
}

// 0: distractor, 1: target, 2: obstacle.
Scene sweep(const std::string& barred = "pan") {
  Scene scene;
  scene.task = "sweep";
  scene.objects = {object("heart", role::distractor, {.6, .16}, 1), object("block", role::target, {.375, .05}, 2),
                   object(barred, "obstacle", {.375, -.16}, 3)};
  scene.objects[2].yaw_rad = pi / 2;
  return scene;
}

TEST(Sweep, SucceedsInEitherZone) {
  const Scene scene = sweep();
  for (const double side : {-1.0, 1.0}) {
    const auto at = [&](double y) { return judge_moved(scene, 1, {.3, side * y}, 1, took_target); };
    EXPECT_EQ(at(.3399), "missed_zone");
    EXPECT_EQ(at(.3401), failure::none);
    EXPECT_EQ(at(.4799), failure::none);
    EXPECT_EQ(at(.4801), "missed_zone");
    EXPECT_EQ(at(.51), "left_workspace");
  }
}

TEST(OtherLimits, InAStripItsMiddleMustBeNearToo) {
  const Scene scene = sweep();
  auto poses = start(scene);
  poses[1].position_m = {.3, -.36, 0};
  EXPECT_NEAR(off_m(scene, poses), .05, 1e-12);
  EXPECT_EQ(judge(scene, poses, took_target, {.06}), failure::none);
  EXPECT_EQ(judge(scene, poses, took_target, {.04}), "missed_zone");
  poses[1].position_m.y = -.33;
  EXPECT_EQ(judge(scene, poses, took_target, {1}), "missed_zone") << "the strip stays as it is painted";
}

TEST(Sweep, SaysWhatWentWrong) {
  const Scene scene = sweep();
  EXPECT_EQ(judge(scene, start(scene), took_nothing), "missed_object");
  EXPECT_EQ(judge(scene, start(scene), took_distractor), "wrong_object");
  EXPECT_EQ(judge(scene, start(scene), {2, true, "touched_obstacle"}), "touched_obstacle");
  EXPECT_EQ(judge_moved(scene, 1, {.375, .41}, 0, {1, true, "touched_obstacle"}), "touched_obstacle");
  EXPECT_EQ(judge_moved(scene, 1, {.375, .41}, 0, {1, false, "touched_obstacle"}), failure::truncated);
}

TEST(Sweep, TouchingIsContactOrOverlapSeenFromAbove) {
  const Scene scene = sweep("line");
  auto poses = start(scene);
  const auto touches = [&](const std::vector<Contact>& contacts, const std::vector<Polygon>& spatula = {}) {
    return touches_obstacle(scene, poses, contacts, spatula);
  };
  EXPECT_FALSE(touches({{0, 2}, {2, table_body}, {1, table_body}, {1, spatula_body}, {0, 1}}));
  EXPECT_TRUE(touches({{1, 2}}));
  EXPECT_TRUE(touches({{2, 1}}));
  EXPECT_TRUE(touches({{spatula_body, 2}}));
  poses[1].position_m = {.375, -.16 + .02 + .035 + 1e-4, 0};
  EXPECT_FALSE(touches({}));
  poses[1].position_m.y -= 2e-4;
  EXPECT_TRUE(touches({}));
  poses = start(scene);
  const auto strip = [](double y) {
    return std::vector<Polygon>{{{.3, y - .01}, {.45, y - .01}, {.45, y + .01}, {.3, y + .01}}};
  };
  EXPECT_FALSE(touches({}, strip(-.16 + .0301)));
  EXPECT_TRUE(touches({}, strip(-.16 + .0299)));
}

TEST(Sweep, NoneOfSeveralObstaclesMayBeTouchedAndADistractorMay) {
  Scene scene = sweep("fork");
  scene.objects.push_back(object("spoon", "obstacle", {.375, -.24}, 4));
  scene.objects[3].yaw_rad = pi / 2;
  const auto poses = start(scene);
  const auto touches = [&](const std::vector<Contact>& contacts, const std::vector<Polygon>& spatula = {}) {
    return touches_obstacle(scene, poses, contacts, spatula);
  };
  EXPECT_TRUE(touches({{1, 2}}));
  EXPECT_TRUE(touches({{3, 1}}));
  EXPECT_TRUE(touches({{spatula_body, 3}}));
  EXPECT_FALSE(touches({{2, 3}, {1, 0}, {spatula_body, 0}, {spatula_body, table_body}, {3, table_body}}));
  EXPECT_TRUE(touches({}, {{{.3, -.25}, {.45, -.25}, {.45, -.23}, {.3, -.23}}}));
}

TEST(Sweep, NeedsATargetAndAnObstacle) {
  Scene scene = sweep();
  scene.objects[2].role = role::distractor;
  EXPECT_THROW(touches_obstacle(scene, start(scene), {}, {}), InputError);
}

// 0: distractor, 1: target, 2: support.
Scene on_hexagon() {
  Scene scene;
  scene.task = "stack";
  scene.objects = {object("block", role::distractor, {.4, -.3}, 1), object("small block", role::target, {.6, -.1}, 2),
                   object("hexagon", "support", {.4, .2}, 3)};
  return scene;
}

std::map<std::string, double> gaps_of(const Scene& scene, const std::vector<Pose>& poses, const Motion& motion,
                                      const TwoPoses& action = {}) {
  std::map<std::string, double> by_part;
  for (const Gap& gap : gaps(scene, action, start(scene), poses, motion)) by_part[gap.part] = gap.value;
  return by_part;
}

TEST(Gaps, AreAllZeroExactlyWhereThePosesSucceed) {
  RandomStream random("gaps");
  for (const Scene& scene : {bring(), turn(120), sweep(), on_hexagon()}) {
    int successes = 0;
    const std::size_t parts = gaps_of(scene, start(scene), took_nothing).size();
    for (int i = 0; i < 3000; ++i) {
      auto poses = start(scene);
      const auto moved = random.below(3) == 0 ? random.below(static_cast<std::uint32_t>(poses.size())) : 1;
      poses[moved].position_m = {random.uniform(.2, .8), random.uniform(-.55, .55), random.uniform(0, .05)};
      if (random.coin()) poses[moved].position_m = {.4, random.coin() ? .3 : .2, .036};
      if (random.coin()) poses[1].position_m = start(scene)[1].position_m;
      poses[1].rotation = from_yaw(random.uniform(-pi, pi));
      const std::size_t taken = random.below(static_cast<std::uint32_t>(poses.size() + 1));
      Motion motion{taken < poses.size() ? static_cast<int>(taken) : no_body, true};
      if (scene.task == "sweep" && random.below(4) == 0) motion.failure = "touched_obstacle";
      const auto by_part = gaps_of(scene, poses, motion);
      const bool all_zero =
          std::all_of(by_part.begin(), by_part.end(), [](const auto& gap) { return gap.second == 0; });
      const bool success = judge(scene, poses, motion) == failure::none;
      EXPECT_EQ(all_zero, success) << scene.task << ' ' << i;
      EXPECT_EQ(by_part.size(), parts);
      for (const auto& [part, value] : by_part) EXPECT_GE(value, 0) << part;
      successes += success;
    }
    EXPECT_GT(successes, 30) << scene.task;
  }
}

TEST(Gaps, AreMetresAndDegreesToWhereSuccessBegins) {
  const auto moved = [](const Scene& scene, std::size_t which, Vec2 to, double yaw, const Motion& motion) {
    auto poses = start(scene);
    poses[which] = {{to.x, to.y, 0}, from_yaw(yaw)};
    return gaps_of(scene, poses, motion, {{{.5, -.1}, {}}, {{.5, .3}, {}}});
  };
  const Scene to_pallet = bring(), rotated = turn(120), swept = sweep();
  EXPECT_NEAR(moved(to_pallet, 1, {.5, .05}, 0, took_target)["place_m"], .15, 1e-12);
  EXPECT_EQ(moved(to_pallet, 1, {.5, .05}, 0, took_target)["reach_m"], 0);
  EXPECT_NEAR(moved(to_pallet, 0, {.5, .27}, 0, took_distractor)["others_m"], .07, 1e-12);
  EXPECT_NEAR(moved(to_pallet, 0, {.2, -.6}, 0, took_distractor)["outside_m"], std::hypot(.05, .1), 1e-12);
  const double beside_m = moved(to_pallet, 1, {.6, -.1}, 0, took_nothing)["reach_m"];
  EXPECT_GT(beside_m, .02);
  EXPECT_LT(beside_m, .1) << "to the heart's edge, not to its centre";
  EXPECT_EQ(moved(to_pallet, 1, {.6, -.1}, 0, took_nothing)["pick"], 1);
  EXPECT_NEAR(moved(rotated, 1, {.6, -.1}, 1 + pi / 2, took_target)["turn_deg"], 15, 1e-9);
  EXPECT_NEAR(moved(rotated, 1, {.6, .1}, 1, took_target)["place_m"], .1, 1e-12);
  EXPECT_NEAR(moved(rotated, 0, {.4, -.25}, 0, took_distractor)["others_m"], .03, 1e-12);
  EXPECT_NEAR(moved(swept, 1, {.375, -.3}, 0, took_target)["place_m"], .04, 1e-12);
  EXPECT_EQ(moved(swept, 1, {.375, .41}, 0, {1, true, "touched_obstacle"})["obstacle"], 1);
  // The blade, .12 wide, passes over x from .44 to .56, and the target's edge is at .41.
  EXPECT_NEAR(moved(swept, 1, {.375, .05}, 0, took_nothing)["reach_m"], .03, 1e-9);
}

TEST(Gaps, OfSeveralTargetsAreOfTheOneThatWasTakenOrIsNearest) {
  Scene scene = bring();
  scene.objects.push_back(object("star", role::target, {.5, -.1}, 4));
  const auto near_star = [&](const Motion& motion) {
    return gaps_of(scene, start(scene), motion, {{{.5, -.1}, {}}, {{.5, .3}, {}}});
  };
  EXPECT_EQ(near_star(took_nothing)["reach_m"], 0) << "the star's";
  EXPECT_NEAR(near_star(took_nothing)["place_m"], .3, 1e-12);
  EXPECT_NEAR(near_star(took_target)["place_m"], std::hypot(.1, .4) - .1, 1e-12) << "the heart's";
}

}  // namespace
}  // namespace lgabench::tabletop
