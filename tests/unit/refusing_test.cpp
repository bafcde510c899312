// Refusing: arms that differ in one thing, what is demonstrated, and how the only action is judged.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/cell/reference_actor.hpp>
#include <lgabench/core/turns.hpp>
#include <tabletop/failures.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/task.hpp>

#include "../engine_under_test.hpp"
#include "testing.hpp"

namespace lgabench::tabletop {
namespace {

std::vector<std::string> all_refusing() {
  std::vector<std::string> ids;
  for (const std::string& id : scenario_ids())
    if (id.rfind("refusing_", 0) == 0) ids.push_back(id);
  return ids;
}

std::vector<Named> things_of(const Scene& scene) {
  std::vector<Named> names;
  for (const SceneObject& o : scene.objects)
    if (o.role != role::goal) names.push_back({o.object_type, o.texture});
  return names;
}

// What the command means of that, by its meaning's own function.
std::vector<Named> meant_of(const Scenario& scenario, const Scene& scene) {
  std::vector<Named> meant;
  for (const Named& one : things_of(scene))
    if (scenario.commands.front().truth.target.belongs(one.object_type, one.texture)) meant.push_back(one);
  return meant;
}

class RefusingScenes : public testing::TestWithParam<std::string> {
 protected:
  Scene test(const std::string& arm, int index) const {
    return sample_scene(scenario, {"continuous", "test", arm, 7}, index);
  }
  const Scenario scenario = load_scenario(GetParam());
};

TEST_P(RefusingScenes, ArmsAreOneTableButForOneThing) {
  for (int k = 0; k < 6; ++k) {
    const Scene gone = test("gone", k), control = test("control", k);
    ASSERT_EQ(gone.objects.size(), 8u) << "seven things and the pallet";
    ASSERT_EQ(control.objects.size(), 8u);
    std::vector<std::size_t> exchanged;
    for (std::size_t i = 0; i < gone.objects.size(); ++i) {
      const SceneObject &one = gone.objects[i], &other = control.objects[i];
      EXPECT_EQ(one.instance_id, other.instance_id);
      if (one.object_type != other.object_type || one.texture != other.texture) {
        exchanged.push_back(i);
        continue;
      }
      EXPECT_EQ(one.position_m.x, other.position_m.x);
      EXPECT_EQ(one.position_m.y, other.position_m.y);
      EXPECT_EQ(one.yaw_rad, other.yaw_rad);
      EXPECT_EQ(one.role, other.role);
    }
    ASSERT_EQ(exchanged.size(), 1u) << k;
    const SceneObject& exchanged_for = control.objects[exchanged.front()];
    EXPECT_EQ(meant_of(scenario, gone), std::vector<Named>());
    EXPECT_EQ(gone.find(role::target), nullptr);
    EXPECT_TRUE(is_done(*gone.errand, things_of(gone), {}));
    EXPECT_EQ(meant_of(scenario, control), (std::vector<Named>{{exchanged_for.object_type, exchanged_for.texture}}));
    EXPECT_EQ(exchanged_for.role, role::target);
    EXPECT_FALSE(is_done(*control.errand, things_of(control), {}));
    EXPECT_EQ(drawn(gone).instances.size(), 8u);
  }
}

TEST_P(RefusingScenes, EveryOtherDemonstrationShowsNothingThatIsMeant) {
  for (int i = 0; i < 6; ++i) {
    const Scene scene = training_scene(scenario, "continuous", {}, 7, i);
    EXPECT_EQ(scene.objects.size(), 6u) << "no test scene has so few";
    EXPECT_EQ(meant_of(scenario, scene).size(), i % 2 == 0 ? 1u : 0u);
    EXPECT_EQ(scene.find(role::target) != nullptr, i % 2 == 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, RefusingScenes, testing::ValuesIn(all_refusing()));

std::string why_refused(const Json& members) {
  Json json = load_scenario("refusing_heart").json;
  json.merge_patch(members);
  try {
    read_scenario(json, "file");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Refusing, BadFilesAreRefused) {
  EXPECT_EQ(why_refused(Json::object()), "");
  EXPECT_SAYS(why_refused({{"may_stop", nullptr}}), "\"may_stop\": true");
  EXPECT_SAYS(why_refused({{"near_miss_sets", Json::array()}}), "/near_miss_sets: expected what scenes can show");
  EXPECT_SAYS(why_refused({{"undecided", "ring"}}), "/undecided: expected");
  EXPECT_SAYS(why_refused({{"tests", {{{"arm", "gone"}}}}}), "is_there");
  EXPECT_SAYS(why_refused({{"pair", Json::array()}}), "pair");
  Json commands = load_scenario("refusing_heart").json.at("commands");
  commands.push_back(commands.front());
  commands.back()["utterance"] = "Bring me any heart.";
  EXPECT_SAYS(why_refused({{"commands", commands}}), "/commands: expected one command");
}

class RefusingEpisodes : public testing::Test {
 protected:
  std::vector<TestScene> tests(const std::string& arm, int n) const {
    std::vector<TestScene> all;
    for (int i = 0; i < n; ++i)
      all.push_back(in_its_arm(scenario, test_scene(scenario, "continuous", arm, 7, i), std::nullopt));
    return all;
  }
  // Words of the ends, where the first scene's only action is that.
  template <class Choose>
  Failure end_of(const std::string& arm, const Choose& choose) {
    const Scene scene = test_scene(scenario, "continuous", arm, 7, 0);
    environment->reset(scene);
    const StepResult end = environment->step(choose(scene));
    EXPECT_TRUE(end.terminated);
    EXPECT_EQ(end.is_success, end.failure == failure::none);
    return end.failure;
  }
  Action takes(const Scene& scene, const char* role) const {
    return environment->expert_action_for(expect(scene, role).instance_id);
  }

  const Scenario scenario = load_scenario("refusing_heart");
  std::unique_ptr<Environment> environment = make_environment(scenario, make_engine());
};

TEST_F(RefusingEpisodes, TheOnlyActionIsJudged) {
  const auto done = [](const Scene&) { return Action(); };
  const auto misses = [](const Scene&) { return Action(TwoPoses({{.3, .49}, {}}, {{.3, .49}, {}})); };
  const auto other = [this](const Scene& scene) { return takes(scene, role::distractor); };
  const auto meant = [this](const Scene& scene) { return takes(scene, role::target); };
  const auto beside = [this](const Scene& scene) {
    TwoPoses action = executable(environment->action_space(), takes(scene, role::target));
    action.pose1.position_m = {.5, .1};
    return Action(action);
  };
  EXPECT_EQ(end_of("gone", done), failure::none);
  EXPECT_EQ(end_of("gone", other), failure::went_on);
  EXPECT_EQ(end_of("gone", misses), failure::missed_object);
  EXPECT_EQ(end_of("control", done), failure::too_early);
  EXPECT_EQ(end_of("control", meant), failure::none);
  EXPECT_EQ(end_of("control", other), failure::not_wanted);
  EXPECT_EQ(end_of("control", misses), failure::missed_object);
  EXPECT_EQ(end_of("control", beside), failure::bad_placement);
}

TEST_F(RefusingEpisodes, TheOracleIsRightInBothArmsAndWhoStopsAtOnceInOne) {
  for (const Arm& arm : scenario.tests) {
    for (const Episode& e : evaluate(*environment, tests(arm.id, 6), reference_actor("oracle"), [](int) {})) {
      EXPECT_TRUE(e.success()) << arm.id << " " << e.index << ": " << e.failure;
      EXPECT_EQ(e.actions().size(), 1u);
      EXPECT_EQ(e.done, arm.id == "gone");
    }
    for (const Episode& e : evaluate(*environment, tests(arm.id, 6), reference_actor("stops_at_once"), [](int) {}))
      EXPECT_EQ(e.failure, arm.id == "gone" ? failure::none : failure::too_early);
  }
}

}  // namespace
}  // namespace lgabench::tabletop
