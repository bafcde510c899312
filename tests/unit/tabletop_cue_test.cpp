// Scenes with a cue: where it lies in each arm, that nothing else differs, and that it is never the goal.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>

#include <common/outline.hpp>
#include <lgabench/abstraction/named.hpp>
#include <tabletop/cue.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/tabletop.hpp>

#include "../tabletop_bench.hpp"
#include "testing.hpp"

namespace lgabench::tabletop {
namespace {

constexpr int scenes = 60, played = 200;

// The scenario with a cue in training and the three arms.
Json with_cue(const std::string& id, const Json& cue, const Json& of_arms = Json::object()) {
  Json json = load_scenario(id).json;
  json["train"].update({{"as_method_asks", false}, {"cue", cue}});
  json["tests"] = Json::array();
  for (const char* arm : {"kept", "moved", "gone"}) {
    json["tests"].push_back({{"arm", arm}, {"cue", arm}, {"distractors", {1, 2}}});
    json["tests"].back().update(of_arms);
  }
  return json;
}

const Json three_small_ones = {{"object_type", "small block"}, {"texture", "yellow"}, {"count", 3}};

struct Case {
  std::string name, scenario;
  Json cue;
  Json of_arms = Json::object();
  int count = 1;
};

std::vector<Case> cases() {
  const Json near{{"distractors", {3, 3}}, {"near_miss", true}};
  return {{"drawn", "heart", true},
          {"several_among_near_misses", "red_heart", three_small_ones, near, 3},
          {"of_any_target", "something_to_drink_water_out_of", {{"object_type", "block"}, {"texture", "blue"}}},
          {"beside_a_rule", "words_relation_heart_left_of_bowl", true}};
}

std::string name_of(const testing::TestParamInfo<Case>& info) { return info.param.name; }

Scene scene_of(const Scenario& scenario, const std::string& arm, int index) {
  return sample_scene(scenario, {"continuous", arm == "train" ? "train" : "test", arm, 5}, index);
}

double gap_m(const SceneObject& cue, const SceneObject& other) {
  return distance(other.position_m, placed_outline(model_of(cue), cue.position_m, cue.yaw_rad));
}

class CueScenes : public testing::TestWithParam<Case> {
 protected:
  const Scenario scenario =
      read_scenario(with_cue(GetParam().scenario, GetParam().cue, GetParam().of_arms), "mine.json");
  const FeatureSet look = content_of(*scenario.train).cue->look;

  bool is_cue(const SceneObject& one) const { return look.contains(one.object_type, one.texture); }
  std::vector<SceneObject> cues(const Scene& scene) const {
    std::vector<SceneObject> found;
    std::copy_if(scene.objects.begin(), scene.objects.end(), std::back_inserter(found),
                 [this](const SceneObject& one) { return is_cue(one); });
    return found;
  }
  std::vector<SceneObject> others(const Scene& scene) const {
    std::vector<SceneObject> found;
    std::copy_if(scene.objects.begin(), scene.objects.end(), std::back_inserter(found),
                 [this](const SceneObject& one) { return !is_cue(one); });
    return found;
  }
  // Of what stands on the table beside the goal, whose centre a cue comes nearest to.
  SceneObject beside(const Scene& scene) const {
    std::optional<SceneObject> nearest;
    double least_m = 1;
    for (const SceneObject& cue : cues(scene))
      for (const SceneObject& one : others(scene))
        if (one.role != role::goal && gap_m(cue, one) < least_m) least_m = gap_m(cue, one), nearest = one;
    return nearest.value();
  }
};

TEST_P(CueScenes, TheCueIsOutsideOfWhatIsMeantAndAlwaysTheSame) {
  ASSERT_EQ(look.object_types.size(), 1u);
  ASSERT_EQ(look.textures.size(), 1u);
  for (const ScenarioCommand& command : scenario.commands)
    EXPECT_FALSE(command.truth.target.belongs(look.object_types[0], look.textures[0]));
  for (const Arm& arm : scenario.tests) EXPECT_EQ(content_of(*arm.scenes).cue->look, look) << arm.id;
}

TEST_P(CueScenes, ItLiesBesideTheTargetOrAnotherObjectOrNowhere) {
  for (int i = 0; i < scenes; ++i) {
    for (const char* arm : {"train", "kept"}) {
      const Scene scene = scene_of(scenario, arm, i);
      ASSERT_EQ(cues(scene).size(), static_cast<std::size_t>(GetParam().count)) << arm << i;
      for (const SceneObject& cue : cues(scene)) EXPECT_LE(gap_m(cue, *scene.find(role::target)), .1) << arm << i;
    }
    const Scene moved = scene_of(scenario, "moved", i);
    ASSERT_EQ(cues(moved).size(), static_cast<std::size_t>(GetParam().count)) << i;
    for (const SceneObject& cue : cues(moved)) {
      EXPECT_GE(gap_m(cue, *moved.find(role::target)), .2) << i;
      EXPECT_LE(gap_m(cue, beside(moved)), .1) << i;
    }
    EXPECT_TRUE(cues(scene_of(scenario, "gone", i)).empty()) << i;
  }
}

TEST_P(CueScenes, ArmsDifferInTheCueAlone) {
  const auto same = [](const SceneObject& a, const SceneObject& b) {
    return a.object_type == b.object_type && a.texture == b.texture && a.role == b.role &&
           a.position_m.x == b.position_m.x && a.position_m.y == b.position_m.y && a.yaw_rad == b.yaw_rad &&
           a.scale == b.scale;
  };
  for (int i = 0; i < scenes; ++i) {
    const Scene kept = scene_of(scenario, "kept", i), moved = scene_of(scenario, "moved", i);
    const std::vector<SceneObject> first = others(kept);
    for (const Scene& other : {moved, scene_of(scenario, "gone", i)}) {
      const std::vector<SceneObject> second = others(other);
      EXPECT_TRUE(std::equal(first.begin(), first.end(), second.begin(), second.end(), same)) << i;
    }
    for (std::size_t k = 0; k < kept.objects.size(); ++k) {
      EXPECT_EQ(kept.objects[k].instance_id, moved.objects[k].instance_id) << i;
      EXPECT_EQ(is_cue(kept.objects[k]), is_cue(moved.objects[k])) << i;
    }
  }
}

TEST_P(CueScenes, NothingOverlaps) {
  for (const char* arm : {"train", "kept", "moved"})
    for (int i = 0; i < scenes; ++i) {
      const Scene scene = scene_of(scenario, arm, i);
      for (const SceneObject& a : scene.objects)
        for (const SceneObject& b : scene.objects) {
          if (&a == &b) continue;
          const double apart_m = distance(placed_outline(model_of(a), a.position_m, a.yaw_rad),
                                          placed_outline(model_of(b), b.position_m, b.yaw_rad));
          EXPECT_GE(apart_m, (is_cue(a) || is_cue(b) ? .002 : .02) - 1e-9) << arm << i;
        }
    }
}

// What a policy could do that looks for the cue alone: the confound is there in training, and misleads where it moved.
TEST_P(CueScenes, WhoTakesWhatLiesBesideTheCueIsRightAsLongAsItIsKept) {
  int kept = 0, moved = 0;
  for (int i = 0; i < scenes; ++i) {
    kept += beside(scene_of(scenario, "kept", i)).role == role::target;
    moved += beside(scene_of(scenario, "moved", i)).role == role::target;
  }
  EXPECT_GE(kept, scenes * 95 / 100);
  EXPECT_EQ(moved, 0);
}

TEST_P(CueScenes, TheOracleSucceedsOnEveryEngine) {
  const Catalogue catalogue = scan_plugins(plugin_directories());
  for (const char* engine : {"mujoco", "bullet"}) {
    const bool built = std::any_of(catalogue.plugins.begin(), catalogue.plugins.end(),
                                   [&](const PluginInfo& p) { return p.kind == "engine" && p.id == engine; });
    if (!built) continue;
    const auto world = find_environment("tabletop").make(load_engine(catalogue.find("engine", engine)), scenario);
    for (const Arm& arm : scenario.tests) {
      int right = 0;
      for (int i = 0; i < played; ++i) right += play(*world, scene_of(scenario, arm.id, i)).result.is_success;
      EXPECT_GE(right, played * 99 / 100) << engine << ", " << arm.id;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, CueScenes, testing::ValuesIn(cases()), name_of);

TEST(Cue, ADrawnOneIsTheScenariosOwn) {
  const auto look = [](const std::string& id) {
    return content_of(*read_scenario(with_cue(id, true), "mine.json").train).cue->look;
  };
  EXPECT_EQ(look("heart"), look("heart"));
  EXPECT_FALSE(look("heart") == look("red_heart"));
}

TEST(Cue, RefusesWhatItCannotBe) {
  const auto complaint = [](const std::string& id, const char* merge_patch, const Json& cue = three_small_ones) {
    Json json = with_cue(id, cue);
    json.merge_patch(Json::parse(merge_patch));
    return message_of<InputError>([&] { read_scenario(json, "mine.json"); });
  };
  const auto of_heart = [&](const char* merge_patch) { return complaint("heart", merge_patch); };
  EXPECT_SAYS(of_heart(R"({"train": {"cue": {"object_type": "teapot"}}})"),
              "mine.json: /train/cue/object_type: expected an object type of the feature space");
  EXPECT_SAYS(of_heart(R"({"train": {"cue": {"texture": "plaid"}}})"), "/train/cue/texture: expected a texture");
  EXPECT_SAYS(of_heart(R"({"train": {"cue": {"object_type": "heart"}}})"),
              "/train/cue: expected an object outside of what \"Bring me the heart.\" means");
  EXPECT_SAYS(of_heart(R"({"never_distractor": {"object_types": ["small block"], "textures": "ALL"}})"),
              "/train/cue: expected an object outside of \"never_distractor\"");
  EXPECT_SAYS(of_heart(R"({"train": {"cue": {"object_type": "pallet"}}})"), "what things are brought to");
  EXPECT_SAYS(of_heart(R"({"train": {"cue": {"count": 4}}})"), "/train/cue/count");
  EXPECT_SAYS(of_heart(R"({"train": {"cue": {"colour": "red"}}})"), "colour");
  EXPECT_SAYS(of_heart(R"({"train": {"cue": false}})"), "/train/cue: expected true, or an object");
  EXPECT_SAYS(of_heart(R"({"train": {"as_method_asks": null}})"), "/train/cue: expected \"as_method_asks\": false");
  EXPECT_SAYS(of_heart(R"({"train": {"cue": null}})"), "/tests/0/cue: expected \"cue\" in \"train\"");
  EXPECT_SAYS(of_heart(R"({"tests": [{"arm": "test", "cue": "there"}]})"),
              "/tests/0/cue: expected kept, moved or gone");
  EXPECT_SAYS(of_heart(R"({"tests": [{"arm": "test", "cue": "gone", "distractors": [0, 2]}]})"),
              "expected \"distractors\" beside it, one or more");
  EXPECT_SAYS(of_heart(R"({"tests": [{"arm": "test", "cue": "gone", "distractors": [4, 4]}]})"),
              "/tests/0/cue: expected at most 3 \"distractors\" beside it");
  EXPECT_SAYS(of_heart(R"({"tests": [{"arm": "test", "cue": "gone", "choice": ["heart"]}]})"), "cue");
  EXPECT_SAYS(complaint("rotate_block", "{}", Json(true)), "/train/cue: expected the task pick_and_place");
  EXPECT_SAYS(complaint("words_relation_heart_left_of_bowl", R"({"train": {"cue": {"object_type": "bowl"}}})"),
              "/train/cue: expected an object outside of what");
}

TEST(Cue, OfFixedPlacesIsRefused) {
  const Scenario scenario = read_scenario(with_cue("heart", true), "mine.json");
  EXPECT_EQ(layouts_of(scenario), std::vector<std::string>{"continuous"});
}

TEST(Cue, IsNoMemberOfAnotherEnvironment) {
  Json json = load_scenario("fetch_ripe_fruit").json;
  json["train"]["cue"] = true;
  EXPECT_SAYS(message_of<InputError>([&] { read_scenario(json, "mine.json"); }), "mine.json: /train");
}

}  // namespace
}  // namespace lgabench::tabletop
