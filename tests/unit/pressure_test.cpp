// What makes an abstraction matter in a scene: many things, and near misses (docs/protocol.md, section 3).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <common/objects.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/harness/expand.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/harness/suite_scenario.hpp>
#include <tabletop/content.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/tabletop.hpp>

#include "../engine_under_test.hpp"
#include "../forwarding_world.hpp"
#include "testing.hpp"

namespace lgabench::tabletop {
namespace {

Scene scene_of(const Scenario& scenario, const std::string& arm, int index) {
  return sample_scene(scenario, {"continuous", arm == "train" ? "train" : "test", arm, 0}, index);
}

std::vector<SceneObject> others(const Scene& scene) {
  std::vector<SceneObject> all;
  std::copy_if(scene.objects.begin(), scene.objects.end(), std::back_inserter(all),
               [](const SceneObject& o) { return o.role == role::distractor; });
  return all;
}

// How often who takes what shares types and textures with most others takes the target: ties in equal parts.
double share_of_target(const Scene& scene) {
  std::vector<SceneObject> all = others(scene);
  all.push_back(*scene.find(role::target));
  const auto shared = [&all](const SceneObject& one) {
    int sum = 0;
    for (const SceneObject& o : all) sum += (o.object_type == one.object_type) + (o.texture == one.texture);
    return sum;
  };
  int most = 0, tied = 0;
  for (const SceneObject& o : all) most = std::max(most, shared(o));
  for (const SceneObject& o : all) tied += shared(o) == most;
  return shared(all.back()) == most ? 1. / tied : 0;
}

TEST(NearMisses, GiveTheTargetAwayToNobodyWhoDoesNotHearTheCommand) {
  constexpr int scenes = 100;
  const Suite suite = load_suite("clutter");
  for (const auto& [arm, count] : {std::pair("near_1", 1), {"near_2", 2}, {"near_4", 4}, {"near_6", 6}}) {
    double share = 0;
    for (const std::string& id : suite.design.scenarios) {
      const Scenario scenario = suite_scenario(suite, id, Truth::released);
      double own = 0;
      for (int i = 0; i < scenes; ++i) own += share_of_target(scene_of(scenario, arm, i)) / scenes;
      EXPECT_NEAR(own, 1. / (count + 1), .12) << id << ", " << arm;
      share += own / static_cast<double>(suite.design.scenarios.size());
    }
    EXPECT_NEAR(share, 1. / (count + 1), .05) << arm;
  }
}

TEST(NearMisses, ShareTypeOrTextureWithTheTargetAndAreNone) {
  const Suite suite = load_suite("clutter");
  for (const std::string& id : suite.design.scenarios) {
    const Scenario scenario = suite_scenario(suite, id, Truth::released);
    const FeatureSet& meant = scenario.commands[0].truth.target.product();
    const bool both = meant.object_types.size() < scenario.space.object_types.size() &&
                      meant.textures.size() < scenario.space.textures.size();
    for (const auto& [arm, count] : {std::pair("near_1", 1), {"near_2", 2}, {"near_4", 4}, {"near_6", 6}})
      for (int i = 0; i < 20; ++i) {
        const Scene scene = scene_of(scenario, arm, i);
        const SceneObject& target = *scene.find(role::target);
        const std::vector<SceneObject> all = others(scene);
        ASSERT_EQ(all.size(), static_cast<std::size_t>(count));
        int near = 0;
        for (const SceneObject& o : all) {
          ASSERT_FALSE(meant.contains(o.object_type, o.texture));
          near += o.object_type == target.object_type || o.texture == target.texture;
        }
        // Of two types crossed with two or three textures, the others share with what shares with the target.
        ASSERT_GE(near, both && count > 2 ? 1 + count / 2 - 1 : count) << id << ", " << arm << " " << i;
      }
  }
}

// The suite's sets: what is nearest to a command's meaning stands beside each target.
TEST(NearMisses, AreFirstOfWhatTheSuiteNames) {
  const Suite suite = load_suite("clutter");
  const Scenario scenario = suite_scenario(suite, "block_that_is_not_l_shaped", Truth::released);
  for (const char* arm : {"near_1", "near_4"})
    for (int i = 0; i < 50; ++i) {
      const std::vector<SceneObject> all = others(scene_of(scenario, arm, i));
      EXPECT_TRUE(std::any_of(all.begin(), all.end(), [](const auto& o) { return o.object_type == "L-shaped block"; }));
    }
}

Scenario with_arm(const std::string& id, Json arm) {
  Json json = load_scenario(id).json;
  arm["arm"] = "test";
  json["tests"] = Json::array({arm});
  return read_scenario(json, id + ".json");
}

TEST(NearMisses, AreRefusedWhereTheyCannotBe) {
  const auto refusal = [](const std::string& id, const Json& arm) {
    return message_of<InputError>([&] { scene_of(with_arm(id, arm), "test", 0); });
  };
  EXPECT_SAYS(refusal("heart", {{"near_miss", "red"}}), "heart.json: /tests/0/near_miss: expected true, or an object");
  EXPECT_SAYS(refusal("heart", {{"near_miss", {{"object_types", {"heart"}}}}}),
              "/tests/0/near_miss/object_types/0: expected a name outside of what \"Bring me the heart.\" means");
  EXPECT_SAYS(refusal("heart", {{"near_miss", {{"textures", {"mauve"}}}}}),
              "/tests/0/near_miss/textures/0: expected a name of the feature space");
  EXPECT_SAYS(refusal("heart", {{"near_miss", true}, {"hard", true}}),
              "/tests/0/hard: expected no such member beside \"near_miss\"");
  EXPECT_SAYS(refusal("heart", {{"near_miss", true}, {"distractors", {0, 0}}}),
              "/tests/0/near_miss: expected \"distractors\" beside it");
  EXPECT_SAYS(refusal("heart", {{"near_miss", true}, {"choice", {"heart", "star"}}}),
              "/tests/0/near_miss: expected no such member beside \"choice\"");
  EXPECT_SAYS(refusal("rotate_block", {{"distractors", {3, 3}}}),
              "/tests/0/distractors/0: expected a whole number from 0 to 2");
  Json all = load_scenario("heart").json;
  all["commands"][0]["truth"]["target"]["object_types"] = "ALL";
  all["tests"] = Json::array({{{"arm", "test"}, {"near_miss", true}}});
  EXPECT_SAYS(message_of<NothingToShow>([&] { scene_of(read_scenario(all, "all"), "test", 0); }),
              "near_miss: expected a command that leaves out types or textures for");
  Json asked = load_scenario("heart").json;
  asked["train"] = {{"near_miss", true}};
  EXPECT_SAYS(message_of<InputError>([&] { read_scenario(asked, "asked"); }),
              "/train/near_miss: expected \"as_method_asks\": false beside it");
}

TEST(Crowds, FindRoomWhereTheTargetStandsInOtherArms) {
  constexpr int scenes = 100;
  const Suite suite = load_suite("clutter");
  int elsewhere = 0, all = 0;
  for (const char* id : {"heart", "tiger_colored_object", "something_that_looks_like_stone", "plain_colored_vessel"}) {
    const Scenario scenario = suite_scenario(suite, id, Truth::released);
    for (const char* arm : {"others_6", "near_6"})
      for (int i = 0; i < scenes; ++i, ++all) {
        const Scene crowd = scene_of(scenario, arm, i), two = scene_of(scenario, "others_2", i);
        ASSERT_EQ(crowd.objects.size(), 8u);
        for (const SceneObject& o : crowd.objects) {
          const Vec2 size = common::object_model(o.object_type).size_m;
          ASSERT_LE(o.role == role::goal ? 0 : std::max(size.x, size.y), .18 + 1e-9) << o.object_type;
        }
        const SceneObject &a = *crowd.find(role::target), &b = *two.find(role::target);
        elsewhere += a.object_type == b.object_type && norm(a.position_m - b.position_m) > 0;
      }
  }
  EXPECT_LT(elsewhere, all / 20);
}

TEST(Crowds, ThatALayoutLacksPlacesForAreRefused) {
  const Scenario scenario = with_arm("heart", {{"distractors", {6, 6}}});
  EXPECT_SAYS(message_of<InputError>([&] {
                sample_scene(scenario, {"cells", "test", "test", 0}, 0);
              }),
              "layout cells: expected places for all 7 objects, got 4");
}

// An engine that counts the bodies that it is to hold.
class Counting : public ForwardingWorld {
 public:
  Counting(std::unique_ptr<PhysicsWorld> world, int& bodies) : ForwardingWorld(std::move(world)), bodies_(bodies) {}
  void load(const std::vector<BodyModel>& models, int bodies) override {
    bodies_ = bodies;
    ForwardingWorld::load(models, bodies);
  }

 private:
  int& bodies_;
};

TEST(Crowds, HaveWorldsThatHoldThemAndNoOthersDo) {
  const EnvironmentType& type = find_environment("tabletop");
  const auto bodies_of = [&type](const Scenario& scenario) {
    int bodies = 0;
    const auto environment = type.make(std::make_unique<Counting>(make_engine(), bodies), scenario);
    const Scene scene = scene_of(scenario, scenario.tests.back().id, 0);
    environment->reset(scene);
    EXPECT_TRUE(environment->step(environment->expert_action()).is_success);
    return bodies;
  };
  EXPECT_EQ(bodies_of(load_scenario("heart")), 6);
  EXPECT_EQ(type.world_of(load_scenario("heart")), "");
  const Scenario crowded = suite_scenario(load_suite("clutter"), "heart", Truth::released);
  EXPECT_EQ(bodies_of(crowded), 8);
  EXPECT_EQ(type.world_of(crowded), "8 bodies") << "its demonstrations are not those of a world of six";
}

TEST(SuiteMembers, ReplaceTrainingArmsAndNearMisses) {
  const Suite suite = load_suite("clutter");
  const Scenario stone = suite_scenario(suite, "something_that_looks_like_stone", Truth::released);
  EXPECT_FALSE(stone.as_method_asks);
  ASSERT_EQ(stone.tests.size(), 8u);
  EXPECT_EQ(stone.tests.front().id, "others_1") << "the scenario's own arm is not played";
  EXPECT_FALSE(content_of(*stone.tests[3].scenes).near_miss);
  EXPECT_EQ(content_of(*stone.tests[7].scenes).near_miss->textures,
            (std::vector<std::string>{"brick", "tiles", "wooden", "magma"}));
  const Scenario heart = suite_scenario(suite, "heart", Truth::released);
  EXPECT_TRUE(content_of(*heart.tests[7].scenes).near_miss->textures.empty());
  EXPECT_EQ(content_of(*heart.tests[7].scenes).near_miss->object_types.size(), 6u);
}

TEST(SuiteMembers, AreRefusedWithTheirPlace) {
  const auto refusal = [](const std::string& member, const Json& value) {
    const TemporaryDirectory directory;
    Json json = read_json(data_directory() / "suites" / "clutter.json");
    json[member] = value;
    write_file(directory.path / "clutter.json", canonical(json));
    return message_of<InputError>([&] {
      const Suite suite = load_suite((directory.path / "clutter.json").string());
      suite_scenario(suite, "heart", Truth::released);
    });
  };
  EXPECT_SAYS(refusal("arms", Json::array()), "clutter.json: /only_arms: expected \"arms\" beside it");
  EXPECT_SAYS(refusal("train", true), "clutter.json: /train: expected an object");
  EXPECT_SAYS(refusal("train", {{"distracters", {1, 1}}}),
              "clutter.json: scenario heart with the suite's members: /train: unknown member \"distracters\"");
  EXPECT_SAYS(refusal("near_miss", {{"hart", true}}), "clutter.json: /near_miss: unknown member \"hart\"");
  EXPECT_SAYS(refusal("near_miss", {{"heart", {{"object_types", {"heart"}}}}}), "expected a name outside of what");
  EXPECT_SAYS(refusal("references", {"least_shared"}), "/references/0: no reference row \"least_shared\"");
}

using Pair = std::pair<std::string, std::string>;

Pair pair_of(const Scene& scene) { return {scene.find(role::target)->object_type, scene.find(role::target)->texture}; }

TEST(Members, AreSeenOrNewAndEachTrainingSeedsOwn) {
  const Suite suite = load_suite("few_members");
  const EnvironmentType& type = find_environment("tabletop");
  for (const std::string& id : suite.design.scenarios) {
    std::set<Pair> fewer;
    for (const int k : {1, 2, 4}) {
      const std::string variant = fmt::format("_members_{}", k);
      const Scenario scenario = suite_scenario(suite, id + variant, Truth::released);
      SCOPED_TRACE(scenario.id);
      std::set<Pair> trained, seen, fresh, of_another;
      for (int i = 0; i < 60; ++i) {
        trained.insert(pair_of(scene_of(scenario, "train", i)));
        const auto test = [&](const char* arm, std::uint64_t seed) {
          return pair_of(sample_scene(scenario, {"continuous", "test", arm + variant, 0, {}, seed}, i));
        };
        seen.insert(test("seen_near", 0));
        fresh.insert(test("new", 0));
        of_another.insert(test("seen", 1));
      }
      EXPECT_EQ(trained.size(), static_cast<std::size_t>(k));
      EXPECT_EQ(seen, trained);
      EXPECT_NE(of_another, trained);
      EXPECT_TRUE(std::includes(trained.begin(), trained.end(), fewer.begin(), fewer.end())) << "fewer are among more";
      fewer = trained;
      for (const Pair& pair : fresh) EXPECT_EQ(trained.count(pair), 0u);
      EXPECT_GT(fresh.size(), 6u);
      std::set<Pair> recorded;
      const Json shown = type.shown_members(scenario, {"continuous", "train", "train", 0});
      for (const Json& pair : shown.at(0)) recorded.emplace(pair.at(0), pair.at(1));
      EXPECT_EQ(recorded, trained) << "selection.json has them";
    }
  }
  EXPECT_TRUE(type.shown_members(load_scenario("heart"), {"continuous", "train", "train", 0}).is_null());
}

TEST(Members, AreRefusedWhereTheyCannotBe) {
  const auto refusal = [](const Json& train, const Json& arm, const char* id = "heart") {
    Json json = load_scenario(id).json;
    json["train"] = train;
    json["tests"] = Json::array({arm});
    json["tests"][0]["arm"] = "test";
    return message_of<InputError>([&] { read_scenario(json, std::string(id) + ".json"); });
  };
  const Json two{{"as_method_asks", false}, {"members", 2}};
  EXPECT_SAYS(refusal({{"members", 2}}, Json::object()),
              "heart.json: /train/members: expected \"as_method_asks\": false beside it");
  EXPECT_SAYS(refusal({{"as_method_asks", false}, {"members", 84}}, Json::object()),
              "/train/members: expected at most 83, the pairs of type and texture that \"Bring me the heart.\" means");
  EXPECT_SAYS(refusal({{"as_method_asks", false}, {"members", 83}}, {{"members", "new"}}),
              "/train/members: expected fewer than 83");
  EXPECT_SAYS(refusal({{"as_method_asks", false}, {"members", 0}}, Json::object()),
              "/train/members: expected a whole number from 1");
  EXPECT_SAYS(refusal({{"as_method_asks", false}}, {{"members", "new"}}),
              "/tests/0/members: expected \"members\" in \"train\"");
  EXPECT_SAYS(refusal(two, {{"members", "old"}}), "/tests/0/members: expected seen, new, new_decisive, new_other");
  EXPECT_SAYS(refusal(two, {{"members", "new"}, {"choice", {"heart", "star"}}}),
              "/tests/0/members: expected no such member beside \"choice\"");
  EXPECT_SAYS(refusal(two, {{"members", "new"}, {"target", {{"object_types", "ALL"}, {"textures", "ALL"}}}}),
              "/tests/0/target: expected no such member beside \"members\"");
}

TEST(Variants, AreScenariosOfTheirOwn) {
  const Suite suite = load_suite("few_members");
  Design design = suite.design;
  design.scenarios = {"heart"};
  EXPECT_EQ(suite_scenario_ids(suite, design),
            (std::vector<std::string>{"heart_members_1", "heart_members_2", "heart_members_4"}));
  const Scenario two = suite_scenario(suite, "heart_members_2", Truth::released);
  EXPECT_EQ(two.id, "heart_members_2");
  EXPECT_EQ(two.answers_of, "heart");
  const std::string variant = "_members_2";
  for (const Arm& arm : two.tests)  // a mean in an arm is over scenarios of one variant
    EXPECT_EQ(arm.id.substr(arm.id.size() - variant.size()), variant);
  design.engines = {}, design.methods = {}, design.options = Json::object(), design.test_scenes = TestScenes::shared;
  EXPECT_SAYS(message_of<InputError>([&] { expand(suite, design, {}, {}); }),
              "few_members.json: /test_scenes: expected per_seed, since \"members\"");
}

// The worlds of the board's first presets.
TEST(ManyCommands, DecoysAreWhatOtherCommandsMeanAndVariantsHearTheFirstOnes) {
  constexpr int scenes = 60;
  const Suite suite = load_suite("many_commands");
  const std::vector<std::string> worlds = preset_design(suite, "abstraction").scenarios;
  const std::size_t all = load_scenario("many_hearts").commands.size();
  for (const auto& [variant, heard] : {std::pair("commands_1", 1u), {"commands_4", 4u}, {"commands_7", 7u}})
    for (const std::string& world : worlds) {
      const Scenario scenario = suite_scenario(suite, fmt::format("{}_{}", world, variant), Truth::released);
      ASSERT_EQ(scenario.commands.size(), heard + 1);
      EXPECT_EQ(scenario.commands_of("train").size(), heard);
      const std::vector<FeatureSet>& sets = content_of(*scenario.train).decoys;
      EXPECT_EQ(sets.size(), all);
      double share = 0;
      for (const std::string& arm :
           {std::string("train"), fmt::format("seen_{}", variant), fmt::format("unseen_{}", variant)})
        for (int i = 0; i < scenes; ++i) {
          const Scene scene = scene_of(scenario, arm, i);
          const FeatureSet& meant = scenario.commands[static_cast<std::size_t>(scene.command)].truth.target.product();
          const std::vector<SceneObject> decoys = others(scene);
          EXPECT_EQ(decoys.size(), arm == "train" ? 3u : 4u);
          for (const SceneObject& decoy : decoys) {
            EXPECT_FALSE(meant.contains(decoy.object_type, decoy.texture));
            EXPECT_TRUE(std::any_of(sets.begin(), sets.end(), [&decoy](const FeatureSet& set) {
              return set.contains(decoy.object_type, decoy.texture);
            }));
          }
          if (arm != "train") share += share_of_target(scene) / (2 * scenes);
        }
      EXPECT_NEAR(share, .2, .13) << world << ", " << variant << ": what shares most is the target by chance";
    }
}

TEST(Paraphrases, AreGivenInTheScenesOfTheCommandAsItIsDemonstrated) {
  constexpr int scenes = 20;
  const Suite suite = load_suite("paraphrases");
  EXPECT_EQ(suite.design.scenarios.size(), 13u);
  for (const std::string& id : suite.design.scenarios) {
    const Scenario scenario = suite_scenario(suite, id, Truth::released);
    ASSERT_EQ(scenario.tests.size(), 5u);
    for (int i = 0; i < scenes; ++i)
      for (std::size_t arm = 0; arm < scenario.tests.size(); ++arm) {
        Json first = to_json(test_scene(scenario, "continuous", "original", 1, i, 2)),
             other = to_json(test_scene(scenario, "continuous", scenario.tests[arm].id, 1, i, 2));
        EXPECT_EQ(other.at("command"), arm);
        for (const char* words : {"arm", "command"}) first.erase(words), other.erase(words);
        EXPECT_EQ(first, other) << id << ", " << scenario.tests[arm].id;
      }
  }
}

}  // namespace
}  // namespace lgabench::tabletop
