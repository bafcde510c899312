// Scenes of commands that are more than one product of types and textures: what each picture shows is what is meant.
#include <gtest/gtest.h>

#include <algorithm>

#include <lgabench/abstraction/named.hpp>
#include <tabletop/alike.hpp>
#include <tabletop/content.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/task.hpp>

#include "testing.hpp"

namespace lgabench::tabletop {
namespace {

std::vector<std::string> scenarios_of(const std::string& suite) {
  std::vector<std::string> ids;
  for (const std::string& id : scenario_ids())
    if (id.rfind(suite + "_", 0) == 0) ids.push_back(id);
  return ids;
}

// Of those that are drawn one of each family.
std::vector<std::string> scenarios_with_meanings() {
  std::vector<std::string> all = scenarios_of("words");
  for (const std::string& id : scenarios_of("drawn"))
    if (id.substr(id.size() - 3) == "_01") all.push_back(id);
  return all;
}

SceneRequest request(const std::string& arm) { return {"continuous", arm == "train" ? "train" : "test", arm, 7}; }

const SceneObject& target_of(const Scene& scene) { return *scene.find(role::target); }

bool holds(const std::vector<FeatureSet>& sets, const SceneObject& object) {
  return std::any_of(sets.begin(), sets.end(),
                     [&](const FeatureSet& set) { return set.contains(object.object_type, object.texture); });
}

class Words : public testing::TestWithParam<std::string> {
 protected:
  const Scenario scenario = load_scenario(GetParam());
  const Meaning& truth = scenario.commands.front().truth.target;
};

TEST_P(Words, ThePictureShowsTheTargetAlone) {
  for (const char* arm : {"train", "test"})
    for (int i = 0; i < 12; ++i) {
      const Scene scene = sample_scene(scenario, request(arm), i);
      EXPECT_EQ(grounded(truth, drawn(scene)), std::vector<std::uint8_t>{target_of(scene).instance_id}) << arm << i;
      for (const SceneObject& object : scene.objects)
        EXPECT_FALSE(holds(tabletop::content_of(scenario, scene.arm).undecided, object))
            << object.object_type << " " << object.texture;
    }
}

TEST_P(Words, EveryTestSceneHasWhatACarelessReadingKeeps) {
  for (int i = 0; i < 12; ++i) {
    const Scene scene = sample_scene(scenario, request("test"), i);
    const auto& near = tabletop::content_of(scenario, scene.arm).near_miss_sets;
    const auto misleads = [&](const SceneObject& object) {
      const bool target = object.role == role::target;
      return !target && (holds(near, object) || (truth.which && truth.belongs(object.object_type, object.texture)));
    };
    EXPECT_TRUE(std::any_of(scene.objects.begin(), scene.objects.end(), misleads)) << i;
  }
}

TEST_P(Words, ASceneIsAFunctionOfItsRequest) {
  EXPECT_EQ(sample_scene(scenario, request("test"), 3).hash(), sample_scene(scenario, request("test"), 3).hash());
  EXPECT_NE(sample_scene(scenario, request("test"), 3).hash(), sample_scene(scenario, request("test"), 4).hash());
}

INSTANTIATE_TEST_SUITE_P(Shipped, Words, testing::ValuesIn(scenarios_with_meanings()));

TEST(MeantScenes, HalfOfTrainingHasNoSecondObjectThatBelongs) {
  const Scenario scenario = load_scenario("words_relation_heart_left_of_bowl");
  int with = 0;
  for (int i = 0; i < 200; ++i) {
    const Scene scene = sample_scene(scenario, request("train"), i);
    with += scene.find(role::not_meant) != nullptr;
    EXPECT_TRUE(std::any_of(scene.objects.begin(), scene.objects.end(), [](const SceneObject& object) {
      return object.object_type == "bowl";
    })) << "the reference always stands there";
  }
  EXPECT_GT(with, 70);
  EXPECT_LT(with, 130);
}

std::vector<Features> objects_of(const Scene& scene) {
  std::vector<Features> all;
  for (const SceneObject& object : scene.objects)
    if (object.role != role::goal) all.push_back({object.object_type, object.texture});
  return all;
}

TEST(MeantScenes, InDrawnOnesNothingButTheWordsTellsTheTarget) {
  const std::vector<std::string> ids = scenarios_of("drawn");
  ASSERT_EQ(ids.size(), 100u);
  for (const std::string& id : ids) {
    const Scenario scenario = load_scenario(id);
    for (int i = 0; i < 5; ++i) {
      const std::vector<Features> all = objects_of(sample_scene(scenario, request("test"), i));
      EXPECT_GE(all.size(), 4u) << id;
      for (const Features& one : all) EXPECT_EQ(shared(one, all), shared(all.front(), all)) << id << " " << i;
    }
  }
}

// Expected share of scenes in which any of the objects that the command's names keep is the target.
double named_tells(const std::string& family, int scenes) {
  double tells = 0;
  const std::vector<std::string> ids = scenarios_of("drawn_2026_" + family);
  for (const std::string& id : ids) {
    const Scenario scenario = load_scenario(id);
    const Meaning named = select_named(scenario.command(0), scenario.space).target;
    for (int i = 0; i < scenes; ++i) {
      const Scene scene = sample_scene(scenario, request("test"), i);
      int all = 0, kept = 0;
      for (const SceneObject& object : scene.objects)
        if (object.role != role::goal) ++all, kept += named.belongs(object.object_type, object.texture);
      const bool right = kept == 0 || named.belongs(target_of(scene).object_type, target_of(scene).texture);
      if (right) tells += 1. / (kept == 0 ? all : kept);
    }
  }
  return tells / (scenes * static_cast<double>(ids.size()));
}

TEST(MeantScenes, InDrawnOnesNamesTellTheTargetWhereTypeAndTextureAreNamedAlone) {
  EXPECT_GT(named_tells("lookup", 5), .75) << "the control";
  for (const char* family : {"category", "negation", "relation", "compound"})
    EXPECT_LT(named_tells(family, 5), .33) << family;
  for (const char* family : {"colour", "union", "superlative"})
    EXPECT_LT(named_tells(family, 5), .6) << family << ": one of two of the type that is named";
}

TEST(MeantScenes, OfColoursHoldTheTargetsTypeInAnotherTextureAndItsTextureOnAnotherType) {
  for (const std::string& id : scenarios_of("drawn_2026_colour")) {
    const Scenario scenario = load_scenario(id);
    for (int i = 0; i < 5; ++i) {
      const Scene scene = sample_scene(scenario, request("test"), i);
      const SceneObject& target = target_of(scene);
      const auto another = [&](const auto& shares) {
        return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& object) {
          return object.role == role::distractor && shares(object);
        });
      };
      EXPECT_TRUE(another([&](const SceneObject& one) { return one.object_type == target.object_type; })) << id << i;
      EXPECT_TRUE(another([&](const SceneObject& one) { return one.texture == target.texture; })) << id << i;
    }
  }
}

TEST(Alike, CompletesWhatIsThere) {
  const std::vector<Features> fresh{{"star", "cyan"}, {"ring", "olive"}};
  const auto any = [](const Features&) { return true; };
  RandomStream random("alike");
  const std::vector<Features> there{{"heart", "red"}, {"heart", "blue"}};
  for (int i = 0; i < 20; ++i) {
    const auto more = sharing_alike(there, fresh, {2, 2}, any, random);
    ASSERT_TRUE(more);
    std::vector<Features> all = there;
    all.insert(all.end(), more->begin(), more->end());
    ASSERT_EQ(all.size(), 4u);
    for (const Features& one : all) EXPECT_EQ(shared(one, all), 2) << "two types crossed with two textures";
  }
  const auto only_stars = [](const Features& one) { return one.type == "star"; };
  EXPECT_FALSE(sharing_alike(there, fresh, {1, 1}, only_stars, random)) << "a star shares less than the hearts";
}

TEST(MeantScenes, OfFixedPlacesAreRefused) {
  const Scenario scenario = load_scenario("words_relation_heart_left_of_bowl");
  EXPECT_SAYS(message_of<InputError>([&] { sample_scene(scenario, {"cells", "test", "test", 0}, 0); }), "continuous");
}

TEST(MeantScenes, RefuseWhatTheyCannotShow) {
  const Json good = load_scenario("words_relation_heart_left_of_bowl").json;
  const auto complaint = [&](const char* merge_patch) {
    Json json = good;
    json.merge_patch(Json::parse(merge_patch));
    return message_of<InputError>([&] { read_scenario(json, "words.json"); });
  };
  EXPECT_SAYS(complaint(R"({"task": "rotate", "angle_deg": 45})"), "pick_and_place");
  EXPECT_SAYS(complaint(R"({"train": {"as_method_asks": null}})"), "as_method_asks");
  EXPECT_SAYS(complaint(R"({"train": {"misleading": 2}})"), "a share from 0 to 1");
  EXPECT_SAYS(complaint(R"({"train": {"hard": true}})"), "hard");
  EXPECT_SAYS(complaint(R"({"near_miss_sets": []})"), "at least one set");
  EXPECT_SAYS(complaint(R"({"tests": [{"arm": "test", "near_miss": {"textures": ["red"]}}]})"),
              "/tests/0/near_miss: expected true or false");
}

}  // namespace
}  // namespace lgabench::tabletop
