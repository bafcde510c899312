// Stack: what its scenes and words are like, and success at its boundaries, without physics.
#include <gtest/gtest.h>

#include <cmath>

#include <common/objects.hpp>
#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/abstraction/prompt.hpp>
#include <lgabench/abstraction/selection_text.hpp>
#include <tabletop/judge.hpp>

#include "testing.hpp"

namespace lgabench::tabletop {
namespace {

constexpr double thick = .036;  // of the hexagon

// 0: distractor, 1: target, 2: support.
Scene stack() {
  Scene scene;
  scene.task = "stack";
  scene.objects = {{"block", "red", role::distractor, {.4, -.3}, 0, 1},
                   {"small block", "red", role::target, {.6, -.1}, 0, 2},
                   {"hexagon", "blue", "support", {.4, .2}, 0, 3}};
  return scene;
}

Failure after(Vec3 target, const Quat& rotation = {}, const Motion& motion = {1, true, failure::none}) {
  const Scene scene = stack();
  std::vector<Pose> poses;
  for (const SceneObject& o : scene.objects) poses.push_back({{o.position_m.x, o.position_m.y, 0}, {}});
  poses[1] = {target, rotation};
  return judge(scene, poses, motion);
}

TEST(Stack, SucceedsOverTheSupportAndLiftedByHalfOfItsHeight) {
  ASSERT_EQ(object_model("hexagon").height_m, thick);
  EXPECT_EQ(after({.4, .2, thick}), failure::none);
  const double apothem = .072 * std::cos(pi / 6);  // to a flat side; yaw 0 turns corners along y
  EXPECT_EQ(after({.4 + apothem - 1e-4, .2, thick}), failure::none);
  EXPECT_EQ(after({.4 + apothem + 1e-4, .2, thick}), "bad_placement");
  EXPECT_EQ(after({.4, .2, thick / 2 + 1e-4}), failure::none);
  EXPECT_EQ(after({.4, .2, thick / 2 - 1e-4}), "bad_placement");
  EXPECT_EQ(after({.6, -.1, thick}), "bad_placement") << "in the air beside it";
}

TEST(Stack, LeaningOnTheTableIsNotOnTop) {
  const Quat leaning{0, std::sin(pi / 8), 0, std::cos(pi / 8)};  // by 45 degrees about y
  EXPECT_EQ(after({.45, .2, .011}, leaning), "bad_placement");
}

TEST(Stack, SaysWhatWentWrong) {
  EXPECT_EQ(after({.6, -.1, 0}, {}, {no_body, true, failure::none}), "missed_object");
  EXPECT_EQ(after({.6, -.1, 0}, {}, {0, true, failure::none}), "wrong_object");
  EXPECT_EQ(after({.6, -.1, 0}, {}, {2, true, failure::none}), "wrong_object") << "the support itself";
  EXPECT_EQ(after({.4, .2, thick}, {}, {1, false, failure::none}), failure::truncated);
  Scene without = stack();
  without.objects[2].role = role::distractor;
  EXPECT_THROW(judge(without, std::vector<Pose>(3, {{.5, 0, 0}, {}}), {1, true, failure::none}), InputError);
}

TEST(Stack, ScenesHoldATargetASupportAndNoPallet) {
  const Scenario scenario = load_scenario("stack_small_block_on_hexagon");
  ASSERT_TRUE(scenario.commands[0].truth.second);
  EXPECT_EQ(scenario.commands[0].truth.second->role, "onto");
  for (const std::string layout : {"cells", "continuous"})
    for (int i = 0; i < 200; ++i) {
      const Scene scene = find_environment("tabletop").sample(scenario, {layout, "test", "test"}, i);
      ASSERT_TRUE(scene.find(role::target) && scene.find("support"));
      EXPECT_EQ(scene.find(role::target)->object_type, "small block");
      EXPECT_EQ(scene.find("support")->object_type, "hexagon");
      EXPECT_FALSE(scene.find(role::goal));
      for (const SceneObject& object : scene.objects)
        if (object.role == role::distractor) {
          EXPECT_NE(object.object_type, "hexagon");
          EXPECT_NE(object.object_type, "small block");
        }
    }
}

TEST(Stack, TheGoalMaskKeepsBothAndTheWordsSayOnto) {
  const Scenario scenario = load_scenario("stack_small_block_on_hexagon");
  const Selection& truth = scenario.commands[0].truth;
  EXPECT_EQ(selection_text(truth, scenario.space), "target: small block; any. onto: hexagon; any");
  const std::string prompt =
      PromptTemplate().fill(scenario.command(0), scenario.space, {Question::About::second, {}, "hexagon"}).user;
  EXPECT_SAYS(prompt, "the object to put it on");
  EXPECT_SILENT(prompt, "avoid");
  const Scene scene = find_environment("tabletop").sample(scenario, {"cells", "test", "test"}, 0);
  const Observation seen = find_environment("tabletop").draw(scene);
  std::vector<std::uint8_t> roles;
  role_mask(seen, truth, roles);
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const int id = seen.ids[i];
    const std::uint8_t expected = id == scene.find(role::target)->instance_id ? target_role
                                  : id == scene.find("support")->instance_id  ? second_role
                                                                              : 0;
    ASSERT_EQ(roles[i], expected) << i;
  }
}

}  // namespace
}  // namespace lgabench::tabletop
