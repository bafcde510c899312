// The statistics of DART's recovery demonstrations (docs/protocol.md, section 5), on an environment that only listens.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/demonstrations.hpp>
#include <tabletop/two_poses.hpp>

namespace lgabench {
namespace {

using tabletop::TwoPoses;

constexpr int per_clean = 5;
constexpr double most = .2;

// Remembers what was executed; every observation and label tells how far the episode went.
class Listener : public Environment {
 public:
  using Outcome = std::function<StepResult(int rollout)>;  // of a scene, from 1
  explicit Listener(Outcome outcome) : outcome_(std::move(outcome)) {}

  Observation reset(const Scene& scene) override {
    if (scene.index != scene_) rollout_ = 0;
    scene_ = scene.index;
    stepped_ = false;
    return {};
  }
  StepResult step(const Action& action) override {
    executed[++rollout_].push_back(action);
    stepped_ = true;
    return outcome_(rollout_);
  }
  Observation observe() override { return {}; }
  Action expert_action() const override { return stepped_ ? second : first; }
  Action expert_action_for(std::uint8_t) const override { return first; }

  const ActionSpace& action_space() const override { return tabletop::two_poses(); }

  const TwoPoses first{{{.4, -.3}, from_yaw(.5)}, {{.6, .2}, from_yaw(-.25)}};
  const TwoPoses second{{{.6, .2}, from_yaw(0)}, {{.5, .3}, from_yaw(0)}};
  std::map<int, std::vector<Action>> executed;  // by rollout

 private:
  Outcome outcome_;
  int scene_ = -1, rollout_ = 0;
  bool stepped_ = false;
};

StepResult ended(const Failure& failure, bool recoverable = true) {
  StepResult result;
  result.failure = failure;
  result.recoverable = recoverable;
  return result;
}

std::vector<Demonstration> demonstrations(Listener& environment, int n) {
  const Scenario scenario = load_scenario("heart");
  std::vector<Scene> scenes;
  for (int i = 0; i < n; ++i) scenes.push_back(training_scene(scenario, "cells", {}, 0, i));
  return demonstrate(environment, scenes, {Needs::Targets::truth, per_clean, most}, {"Bring me the heart."});
}

double deviation(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));  // about the mean that it should have, 0
}

TEST(Dart, DisturbsTheExecutedActionByTheProtocolsDeviations) {
  Listener environment([](int) { return ended("missed_object"); });
  constexpr int n = 1500;
  demonstrations(environment, n);
  ASSERT_EQ(environment.executed.size(), static_cast<std::size_t>(per_clean));
  for (const auto& [k, actions] : environment.executed) {
    ASSERT_EQ(actions.size(), static_cast<std::size_t>(n));
    const double sigma = most * k / per_clean;
    std::vector<double> x, y, yaw, both;
    for (const TwoPoses action : actions) {
      for (const auto& [pose, clean] :
           {std::pair(action.pose0, environment.first.pose0), {action.pose1, environment.first.pose1}}) {
        x.push_back((pose.position_m.x - clean.position_m.x) / (.25 * sigma));
        y.push_back((pose.position_m.y - clean.position_m.y) / (.5 * sigma));
        yaw.push_back(std::remainder(yaw_of(pose.rotation) - yaw_of(clean.rotation), 2 * pi) / (pi * sigma));
      }
      both.push_back((x.end()[-1] - x.end()[-2]) / std::sqrt(2));  // the two poses have noise of their own
    }
    // 3000 values: the deviation's own is 1.3 %.
    for (const auto& [name, values] : {std::pair("x", &x), {"y", &y}, {"yaw", &yaw}, {"difference", &both}}) {
      EXPECT_NEAR(deviation(*values), 1, .06) << name << " in rollout " << k;
      double sum = 0;
      for (const double v : *values) sum += v;
      EXPECT_NEAR(sum / static_cast<double>(values->size()), 0, .1) << name << " in rollout " << k;
    }
    double together = 0;
    for (std::size_t i = 0; i < x.size(); ++i) together += x[i] * y[i] / static_cast<double>(x.size());
    EXPECT_NEAR(together, 0, .1) << "x and y in rollout " << k;
  }
}

TEST(Dart, AddsOnePairForEachRolloutThatIsNotDropped) {
  const auto pairs = [](const Listener::Outcome& outcome) {
    Listener environment(outcome);
    const std::vector<Demonstration> all = demonstrations(environment, 3);
    for (const Demonstration& d : all) {
      bool is_first = true;
      for_each_step(d, [&](const Step& step) {  // noiseless, and of the state reached
        const TwoPoses expected = is_first ? environment.first : environment.second, label = step.label;
        EXPECT_NEAR(label.pose0.position_m.x, expected.pose0.position_m.x, 1e-6);
        EXPECT_NEAR(label.pose1.position_m.y, expected.pose1.position_m.y, 1e-6);
        is_first = false;
      });
    }
    return all.front().steps.size() + all.front().recovery.size();
  };
  EXPECT_EQ(pairs([](int) { return ended(failure::none); }), 1u + per_clean);
  EXPECT_EQ(pairs([](int) { return ended("wrong_object"); }), 1u + per_clean);
  EXPECT_EQ(pairs([](int k) { return ended("left_workspace", k != 2); }), 1u + per_clean - 1);
  EXPECT_EQ(pairs([](int k) { return ended("missed_object", k <= 3); }), 1u + 3);
}

}  // namespace
}  // namespace lgabench
