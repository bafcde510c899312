// Whole episodes on an engine: they begin alike on every engine, depend on their scene alone, and end soundly.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <common/objects.hpp>
#include <lgabench/core/random.hpp>
#include <tabletop/judge.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/task.hpp>

#include "../tabletop_bench.hpp"
#include "amount.hpp"

namespace lgabench::tabletop {
namespace {

// A scenario of each task whose every step has an action; errands_test plays the others.
std::vector<std::string> examples() {
  std::vector<std::string> all;
  for (const Task* task : tasks())
    if (!load_scenario(task->example()).may_stop) all.push_back(task->example());
  return all;
}

Scene scene_of(const std::string& scenario, std::uint64_t seed, int index) {
  return sample_scene(load_scenario(scenario), {"continuous", "test", "test", seed}, index);
}

class AnyTask : public testing::TestWithParam<std::string> {};

TEST_P(AnyTask, BeginsAlikeOnEveryEngine) {
  for (const PluginInfo& plugin : scan_plugins(plugin_directories()).plugins) {
    if (plugin.kind != "engine") continue;
    const auto other = make_environment(load_engine(plugin), load_feature_space("tabletop"));
    for (int i = 0; i < 20; ++i) {
      const Scene scene = scene_of(GetParam(), 3, i);
      const Observation here = environment().reset(scene), there = other->reset(scene);
      EXPECT_EQ(here.rgb, there.rgb) << plugin.id;
      EXPECT_EQ(here.ids, there.ids) << plugin.id;
      EXPECT_EQ(as_stored(two_poses(), environment().expert_action()), as_stored(two_poses(), other->expert_action()))
          << plugin.id;
    }
  }
}

TEST_P(AnyTask, DependsOnItsSceneAlone) {
  const auto same = [](const Episode& a, const Episode& b) {
    return a.first.rgb == b.first.rgb && a.first.ids == b.first.ids &&
           as_stored(two_poses(), a.action) == as_stored(two_poses(), b.action) &&
           a.result.observation.rgb == b.result.observation.rgb && a.result.failure == b.result.failure &&
           a.result.observation.ids == b.result.observation.ids;
  };
  std::vector<Episode> first;
  for (int i = 0; i < 5; ++i) first.push_back(play(environment(), scene_of(GetParam(), 5, i)));
  for (int i = 4; i >= 0; --i)
    EXPECT_TRUE(same(play(environment(), scene_of(GetParam(), 5, i)), first[static_cast<std::size_t>(i)])) << i;
  const Bench other = make_bench();
  EXPECT_TRUE(same(play(*other.environment, scene_of(GetParam(), 5, 3)), first[3]));
}

/// Half of the actions begin on an object, as others mostly take nothing.
TwoPoses random_action(RandomStream& random, const Scene& scene) {
  const auto anywhere = [&] {
    return Vec2{random.uniform(Workspace::x_min, Workspace::x_max), random.uniform(Workspace::y_min, Workspace::y_max)};
  };
  TwoPoses action{{anywhere(), {}}, {anywhere(), from_yaw(random.uniform(-pi, pi))}};
  if (random.coin())
    action.pose0.position_m = scene.objects[random.below(static_cast<std::uint32_t>(scene.objects.size()))].position_m;
  return action;
}

TEST_P(AnyTask, RandomActionsLeaveSoundScenes) {
  constexpr int actions_a_scene = 4;
  const int scenes = amount(60, 10000 / actions_a_scene / 3 + 1);
  RandomStream random(fmt::format("conformance/{}", GetParam()));
  int moved = 0, truncated = 0;
  for (int i = 0; i < scenes; ++i) {
    const Scene scene = scene_of(GetParam(), 11, i);
    environment().reset(scene);
    for (int k = 0; k < actions_a_scene; ++k) {
      const StepResult result = environment().step(random_action(random, scene));
      moved += result.failure != "missed_object";
      truncated += result.truncated;
      for (std::size_t o = 0; o < scene.objects.size(); ++o) {
        const Pose p = bench().world->pose(static_cast<int>(o));
        const std::string which = fmt::format("scene {}, action {}, {}", i, k, scene.objects[o].object_type);
        const Quat& q = p.rotation;
        ASSERT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1, 1e-6) << which;
        // A body on its edge may have its frame below the table, but none falls through or is shot away; a disc may
        // roll.
        ASSERT_LT(std::hypot(p.position_m.x - .5, p.position_m.y), 3) << which;
        ASSERT_LT(p.position_m.z, .4) << which;
        ASSERT_GT(p.position_m.z + object_model(scene.objects[o].object_type).radius_m, 0) << which;
      }
    }
  }
  EXPECT_GT(moved, scenes * actions_a_scene / 4);
  EXPECT_LE(truncated, scenes * actions_a_scene / 100) << "of " << scenes * actions_a_scene;
}

INSTANTIATE_TEST_SUITE_P(Tasks, AnyTask, testing::ValuesIn(examples()));

TEST(Episode, TheLimitInStepsTruncates) {
  bench();
  environment().reset(scene_of(examples().front(), 3, 0));
  bench().world->creeps = true;
  const StepResult result = environment().step(environment().expert_action());
  bench().world->creeps = false;
  EXPECT_TRUE(result.truncated);
  EXPECT_FALSE(result.is_success);
  EXPECT_EQ(result.failure, failure::truncated);
  EXPECT_EQ(bench().world->steps, static_cast<int>(10 / bench().world->time_step_s()));
}

TEST(Episode, WhatLeansOnThePalletComesToRest) {
  Environment& env = environment();
  Scene scene;
  scene.task = "pick_and_place";
  scene.objects = {object("pallet", "wooden", role::goal, {.5, .3}, 1),
                   object("heart", "red", role::target, {.6, -.05}, 2)};
  env.reset(scene);
  TwoPoses action = env.expert_action();
  for (int i = 0; i < 48; ++i) {  // around the pallet, half on it, turned
    const double angle = 2 * pi * i / 24;
    action.pose1 = {Vec2{.5, .3} + rotated({i < 24 ? .10 : .13, 0}, angle), from_yaw(.5 * angle)};
    env.reset(scene);
    EXPECT_FALSE(env.step(action).truncated) << "placement " << i;
  }
}

TEST(Episode, TheSpatulaComesDownOnAnyObjectWithoutHarm) {
  for (const std::string& type : load_feature_space("tabletop").object_types) {
    Scene scene;
    scene.task = "sweep";
    scene.objects = {object(type, "blue", role::distractor, {.6, .25}, 1),
                     object("pan", "green", "obstacle", {.375, -.16}, 2),
                     object("block", "red", role::target, {.375, .05}, 3)};
    for (const Vec2 to : {Vec2{.6, -.2}, Vec2{.65, .45}, Vec2{.6, .25}}) {
      environment().reset(scene);
      StepResult result;
      EXPECT_NO_THROW(result = environment().step(from_to({.6, .25}, to))) << type;
      EXPECT_FALSE(result.truncated) << type;
      EXPECT_LT(std::abs(bench().world->pose(0).position_m.z), .15) << type << " was thrown";
    }
  }
}

}  // namespace
}  // namespace lgabench::tabletop
