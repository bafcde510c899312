// Demonstrations, their file and cache, the evaluator and the reference rows: what a worker does.
#include <algorithm>
#include <cmath>
#include <set>

#include <lgabench/core/files.hpp>
#include <lgabench/harness/constant_action.hpp>
#include <lgabench/harness/demonstrations.hpp>
#include <lgabench/harness/environments.hpp>
#include <lgabench/harness/evaluator.hpp>
#include <lgabench/harness/hdf5.hpp>
#include <lgabench/plugin/loader.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

class Play : public ::testing::Test, public TemporaryDirectory {
 protected:
  static void SetUpTestSuite() {
    scenario = std::make_unique<Scenario>(load_scenario("heart"));
    const Catalogue catalogue = scan_plugins({shipped_plugin_directory()});
    environment = make_environment(*scenario, load_engine(catalogue.find("engine", "mujoco")));
  }
  static void TearDownTestSuite() {
    environment.reset();
    scenario.reset();
  }
  static std::vector<Scene> scenes(int n, std::uint64_t seed = 0) {
    std::vector<Scene> all;
    for (int i = 0; i < n; ++i) all.push_back(training_scene(*scenario, "cells", scenario->truth, seed, i));
    return all;
  }
  static std::vector<Demonstration> demonstrations(int n, int noisy = 0) {
    return demonstrate(*environment, scenes(n), {Needs::Targets::truth, noisy, .2}, scenario->command.utterance);
  }

  static std::unique_ptr<Scenario> scenario;
  static std::unique_ptr<Environment> environment;
};
std::unique_ptr<Scenario> Play::scenario;
std::unique_ptr<Environment> Play::environment;

std::string bytes(const std::vector<Demonstration>& demonstrations) {
  return demonstrations_hdf5(demonstrations, "test");
}

TEST_F(Play, TenDemonstrationsAreAPrefixOfFifty) {
  auto fifty = demonstrations(50, 1);
  fifty.resize(10);
  EXPECT_EQ(bytes(fifty), bytes(demonstrations(10, 1)));
  EXPECT_NE(bytes(fifty), bytes(demonstrate(*environment, scenes(10, 1), {Needs::Targets::truth, 1, .2}, "")));
}

TEST_F(Play, TheFirstStepIsTheOraclesOnTheUntouchedScene) {
  const auto all = demonstrations(3, 2);
  for (int i = 0; i < 3; ++i) {
    const Scene scene = scenes(3)[static_cast<std::size_t>(i)];
    const Observation seen = environment->reset(scene);
    const Demonstration& d = all[static_cast<std::size_t>(i)];
    EXPECT_EQ(d.steps.front().observation.rgb, seen.rgb);
    EXPECT_EQ(d.steps.front().observation.ids, seen.ids);
    EXPECT_EQ(to_vector(d.steps.front().label), to_vector(environment->expert_action()));
    EXPECT_TRUE(environment->step(d.steps.front().label).is_success) << "a label of a file's precision still succeeds";
  }
}

TEST_F(Play, RecoveryAddsDisturbedStatesWithTheirOwnLabels) {
  const auto clean = demonstrations(10), noisy = demonstrations(10, 5);
  std::size_t added = 0, moved = 0;
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    EXPECT_EQ(clean[i].steps.size(), 1u);
    EXPECT_EQ(noisy[i].steps.front().observation.rgb, clean[i].steps.front().observation.rgb);
    EXPECT_LE(noisy[i].steps.size(), 6u);
    added += noisy[i].steps.size() - 1;
    for (const Step& step : noisy[i].steps) moved += step.observation.rgb != clean[i].steps.front().observation.rgb;
  }
  EXPECT_GT(added, 40u) << "most rollouts stay in the workspace";
  EXPECT_GT(moved, added / 4) << "some rollouts take hold of something and move it";
  // Without noise the action succeeds: the state after it has the target on the goal, and the oracle goes there.
  const auto still = demonstrate(*environment, scenes(1), {Needs::Targets::truth, 1, 0.0}, "");
  ASSERT_EQ(still[0].steps.size(), 2u);
  EXPECT_NEAR(still[0].steps[1].label.pose0.position_m.y, still[0].steps[0].label.pose1.position_m.y, .02);
}

TEST_F(Play, FileReadsBackAsItWasWritten) {
  const auto before = demonstrations(3, 2);
  write_file(path / "d.hdf5", bytes(before));
  const auto after = read_demonstrations(path / "d.hdf5");
  ASSERT_EQ(after.size(), before.size());
  EXPECT_EQ(bytes(after), bytes(before));
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i].instruction.utterance, "Bring me the heart.");
    ASSERT_EQ(after[i].steps.size(), before[i].steps.size());
    for (std::size_t t = 0; t < after[i].steps.size(); ++t) {
      const Step &a = after[i].steps[t], &b = before[i].steps[t];
      EXPECT_EQ(a.observation.rgb, b.observation.rgb);
      EXPECT_EQ(a.observation.ids, b.observation.ids);
      EXPECT_EQ(a.observation.instances.size(), b.observation.instances.size());
      EXPECT_EQ(a.observation.instances.back().texture, b.observation.instances.back().texture);
      EXPECT_EQ(a.label.pose0.position_m.x, b.label.pose0.position_m.x) << "to the last bit: cached trains as fresh";
      EXPECT_EQ(a.label.pose1.rotation.z, b.label.pose1.rotation.z);
    }
  }
}

TEST_F(Play, ADamagedFileIsRefusedAndNeverACrash) {
  const std::string good = bytes(demonstrations(1));
  int refused = 0;
  for (int i = 0; i < 100; ++i) {
    std::string bad = good;
    if (i % 2)
      bad.resize(good.size() * static_cast<std::size_t>(i) / 100);
    else  // the structure lies in the first kilobytes
      for (int k = 0; k < 20; ++k)
        bad[static_cast<std::size_t>(i * 131 + k * 7) % good.size()] = static_cast<char>(i * k);
    write_file(path / "d.hdf5", bad);
    try {
      read_demonstrations(path / "d.hdf5");
    } catch (const InputError& e) {
      ++refused;
      EXPECT_EQ(std::string(e.what()).find((path / "d.hdf5").string()), 0u) << e.what();
    }
  }
  EXPECT_GT(refused, 50);
}

TEST_F(Play, CacheIsTheSameAsNoCache) {
  const DemonstrationCache cache{path / "cache", {{"engine", "1"}}, "test"};
  const Needs needs{Needs::Targets::truth, 1, .2};
  const auto cached = [&](int n, const Json& builds) {
    std::vector<int> done;
    const DemonstrationCache with{cache.directory, builds, "test"};
    auto all = cached_demonstrations(with, *environment, scenes(n), needs, "u", [&](int k) { done.push_back(k); });
    EXPECT_EQ(done.back(), n);
    return bytes(all);
  };
  const auto files = [&] { return std::distance(fs::directory_iterator(cache.directory), fs::directory_iterator()); };
  const std::string fresh = bytes(demonstrate(*environment, scenes(15), needs, "u"));
  EXPECT_EQ(cached(15, cache.builds), fresh);
  EXPECT_EQ(files(), 2);
  EXPECT_EQ(cached(15, cache.builds), fresh);
  EXPECT_EQ(files(), 2);
  cached(10, cache.builds);
  EXPECT_EQ(files(), 2) << "ten are the first file of fifteen";
  for (const auto& entry : fs::directory_iterator(cache.directory)) write_file(entry.path(), "damaged");
  EXPECT_EQ(cached(15, cache.builds), fresh);
  EXPECT_EQ(cached(15, {{"engine", "2"}}), fresh);
  EXPECT_EQ(files(), 4) << "another engine's build shares nothing";
}

std::vector<TestScene> tests(const Scenario& scenario, int n) {
  std::vector<TestScene> all;
  for (int i = 0; i < n; ++i) all.push_back({"test", i, test_scene(scenario, "cells", "test", 0, i)});
  return all;
}

int successes(const std::vector<Episode>& episodes) {
  return static_cast<int>(
      std::count_if(episodes.begin(), episodes.end(), [](const Episode& e) { return e.failure == Failure::none; }));
}

TEST_F(Play, ReferenceRows) {
  const auto scenes = tests(*scenario, 60);
  EXPECT_EQ(successes(evaluate(*environment, scenes, reference_actor("oracle"), [](int) {})), 60);
  const auto random = evaluate(*environment, scenes, reference_actor("random_object"), [](int) {});
  // One or two distractors with equal odds: 5/12 expected; 4 sigma of 60 is 15.
  EXPECT_NEAR(successes(random), 25, 15);
  std::set<Failure> kinds;
  for (const Episode& e : random) kinds.insert(e.failure);
  EXPECT_EQ(kinds, (std::set<Failure>{Failure::none, Failure::wrong_object})) << "it always takes something";
  EXPECT_THROW(reference_actor("nothing"), InputError);
}

// A policy that fails in one way on every third scene and does nothing of use on the others.
class Sometimes : public Policy {
 public:
  explicit Sometimes(int way) : way_(way) {}
  void reset() override { ++resets; }
  Action act(const Observation&, const Instruction&) override {
    Action action;
    action.pose0.position_m = action.pose1.position_m = {.5, 0};
    if (resets % 3 != 0) return action;
    if (way_ == 0) throw 42;
    if (way_ == 1) throw InputError("no such sentence");
    if (way_ == 2) throw EngineError("not mine");
    action.pose1.rotation = {0, 0, 0, way_ == 3 ? 0 : std::nan("")};
    return action;
  }
  int resets = 0;

 private:
  int way_;
};

TEST_F(Play, WhateverAMethodDoesFailsItsEpisodeOnly) {
  const Instruction instruction{"u", {}};
  for (int way = 0; way < 5; ++way) {
    Sometimes policy(way);
    const auto episodes =
        evaluate(*environment, tests(*scenario, 6), policy_actor(policy, instruction, "p"), [](int) {});
    ASSERT_EQ(episodes.size(), 6u);
    EXPECT_EQ(policy.resets, 6);
    for (std::size_t i = 0; i < 6; ++i) {
      const bool bad = i % 3 == 2;
      EXPECT_EQ(episodes[i].failure, bad ? Failure::method_error : Failure::missed_object) << way;
      EXPECT_EQ(episodes[i].action.has_value(), !bad);
      EXPECT_EQ(to_json(episodes[i]).at("action").is_null(), bad);
    }
  }
}

TEST_F(Play, AnEmptySelectionFailsEveryEpisodeUnplayed) {
  const auto episodes = without_abstraction(tests(*scenario, 4));
  ASSERT_EQ(episodes.size(), 4u);
  for (const Episode& e : episodes) EXPECT_EQ(e.failure, Failure::abstraction_empty);
  EXPECT_EQ(episodes[2].scene, tests(*scenario, 4)[2].scene.hash());
}

TEST(Constant, IsTheMedoidOfTheLabels) {
  std::vector<Demonstration> demonstrations;
  for (const double y : {.4, -.1, 0.0, .05, -.3}) {
    Action action;
    action.pose0.position_m = {.5, y};
    demonstrations.push_back({{}, {{Observation{}, action}}});
  }
  ConstantAction method;
  struct : TrainingLog {
    void epoch(int, long long, double) override {}
  } log;
  struct : LanguageModel {
    std::vector<bool> answer(const Command&, const FeatureSpace&, const std::vector<Question>&) override { return {}; }
    std::string model() const override { return ""; }
    Provenance provenance() const override { return Provenance::none; }
    SelectionCost cost() const override { return {}; }
  } lm;
  struct : HumanAnswers {
    Selection specify(const Command&) override { return {}; }
    Selection edit(const Command&, const Selection&) override { return {}; }
  } human;
  const Json options = Json::object();
  Services services{lm, human, options, 0, log};
  // Summed distances: .4 1.85, -.1 .95, 0 .85, .05 .90, -.3 1.55
  EXPECT_FLOAT_EQ(to_vector(method.learn(demonstrations, services)->act({}, {}))[1], 0.0f);
  EXPECT_THROW(method.learn({}, services), MethodError);
}

}  // namespace
}  // namespace lgabench
