// Demonstrations, their file and cache, the evaluator and the reference rows: what a worker does.
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/abstraction/taken_looks.hpp>
#include <lgabench/abstraction/textualization.hpp>
#include <lgabench/cell/constant_action.hpp>
#include <lgabench/cell/demonstrations.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/cell/hdf5.hpp>
#include <lgabench/cell/picture.hpp>
#include <lgabench/cell/reference_actor.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/reference_rows.hpp>
#include <tabletop/two_poses.hpp>

#include "../engine_under_test.hpp"
#include "altered_environment.hpp"
#include "testing.hpp"

namespace lgabench {
namespace {

using tabletop::TwoPoses;

class Play : public ::testing::Test, public TemporaryDirectory {
 protected:
  static void SetUpTestSuite() {
    scenario = std::make_unique<Scenario>(load_scenario("heart"));
    environment = make_environment(*scenario, make_engine());
  }
  static void TearDownTestSuite() {
    environment.reset();
    scenario.reset();
  }
  static std::vector<Scene> scenes(int n, std::uint64_t seed = 0) {
    std::vector<Scene> all;
    for (int i = 0; i < n; ++i) all.push_back(training_scene(*scenario, "cells", {}, seed, i));
    return all;
  }
  static std::vector<Demonstration> demonstrations(int n, int noisy = 0) {
    return demonstrate(*environment, scenes(n), {Needs::Targets::truth, noisy, .2}, {"Bring me the heart."});
  }

  static std::unique_ptr<Scenario> scenario;
  static std::unique_ptr<Environment> environment;
};
std::unique_ptr<Scenario> Play::scenario;
std::unique_ptr<Environment> Play::environment;

std::string bytes(const std::vector<Demonstration>& demonstrations) {
  return demonstrations_hdf5(demonstrations, "test");
}

TEST_F(Play, AnEpisodeThatGoesOnAfterItsOneActionIsTheEnvironmentsFault) {
  const AlteredType type(*scenario->environment, [](StepResult& result) { result.terminated = false; });
  Scenario goes_on = *scenario;
  goes_on.environment = &type;
  const auto played = make_environment(goes_on, make_engine());
  const Scene scene = scenes(3).back();
  EXPECT_SAYS(message_of<EngineError>([&] { evaluate(*played, {{scene}}, reference_actor("oracle"), [](int) {}); }),
              "environment tabletop: scene 2 of train: the episode goes on after its action, and lgabench plays one");
}

TEST_F(Play, TenDemonstrationsAreAPrefixOfFifty) {
  auto fifty = demonstrations(50, 1);
  fifty.resize(10);
  EXPECT_EQ(bytes(fifty), bytes(demonstrations(10, 1)));
  EXPECT_NE(bytes(fifty), bytes(demonstrate(*environment, scenes(10, 1), {Needs::Targets::truth, 1, .2}, {""})));
}

TEST_F(Play, TheFirstStepIsTheOraclesOnTheUntouchedScene) {
  const auto all = demonstrations(3, 2);
  for (int i = 0; i < 3; ++i) {
    const Scene scene = scenes(3)[static_cast<std::size_t>(i)];
    const Observation seen = environment->reset(scene);
    const Demonstration& d = all[static_cast<std::size_t>(i)];
    EXPECT_EQ(d.steps.front().observation.rgb, seen.rgb);
    EXPECT_EQ(d.steps.front().observation.ids, seen.ids);
    EXPECT_EQ(d.steps.front().label, as_stored(environment->action_space(), environment->expert_action()));
    EXPECT_TRUE(environment->step(d.steps.front().label).is_success) << "a label of a file's precision still succeeds";
  }
}

TEST_F(Play, RecoveryAddsDisturbedStatesWithTheirOwnLabels) {
  const auto clean = demonstrations(10), noisy = demonstrations(10, 5);
  std::size_t added = 0, moved = 0;
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    EXPECT_EQ(clean[i].steps.size(), 1u);
    EXPECT_EQ(noisy[i].steps.front().observation.rgb, clean[i].steps.front().observation.rgb);
    EXPECT_EQ(noisy[i].steps.size(), 1u);
    EXPECT_LE(noisy[i].recovery.size(), 5u);
    added += noisy[i].recovery.size();
    for (const Step& step : noisy[i].recovery) moved += step.observation.rgb != clean[i].steps.front().observation.rgb;
  }
  EXPECT_GT(added, 40u) << "most rollouts stay in the workspace";
  EXPECT_GT(moved, added / 4) << "some rollouts take hold of something and move it";
  // Without noise the action succeeds: the state after it has the target on the goal, and the oracle goes there.
  const auto still = demonstrate(*environment, scenes(1), {Needs::Targets::truth, 1, 0.0}, {""});
  ASSERT_EQ(still[0].recovery.size(), 1u);
  EXPECT_NEAR(TwoPoses(still[0].recovery[0].label).pose0.position_m.y,
              TwoPoses(still[0].steps[0].label).pose1.position_m.y, .02);
}

TEST_F(Play, CallsOutOfOrderAreErrorsAndMayBeMadeRight) {
  const auto fresh = make_environment(*scenario, make_engine());
  const Scene scene = scenes(1).front();
  const std::function<void()> calls[] = {[&] { fresh->step(TwoPoses()); }, [&] { fresh->observe(); },
                                         [&] { fresh->expert_action(); }, [&] { fresh->expert_action_for(1); }};
  for (const auto& call : calls) EXPECT_SAYS(message_of<Error>(call), "expected a reset() before it");
  fresh->reset(scene);
  EXPECT_TRUE(fresh->step(fresh->expert_action()).is_success);
  Scene unknown = scene;
  unknown.objects.front().object_type = "unicorn";
  EXPECT_THROW(fresh->reset(unknown), InputError);
  for (const auto& call : calls) EXPECT_SAYS(message_of<Error>(call), "expected a reset() before it");
}

TEST_F(Play, CircumstancesAddToAFileAndItReadsBackAsBefore) {
  const auto shown = scenes(10);
  Circumstances c{"heart", "kinematic", "cells", "train", 0, environment->action_space(), {}};
  const auto before = demonstrate(*environment, shown, {Needs::Targets::truth, 1, .2}, {"u"}, &c.outcomes);
  const auto without = demonstrate(*environment, shown, {Needs::Targets::truth, 1, .2}, {"u"});
  EXPECT_EQ(bytes(before), bytes(without)) << "carrying labels out changes none";
  ASSERT_EQ(c.outcomes.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_EQ(c.outcomes[i].size(), 1 + before[i].recovery.size());
    EXPECT_TRUE(c.outcomes[i].front().is_success);
  }
  const std::string more = demonstrations_hdf5(before, "test", &c);
  EXPECT_GT(more.size(), bytes(before).size());
  EXPECT_EQ(bytes(read_demonstrations(more, "more.hdf5")), bytes(before));
}

TEST_F(Play, ShadowsAreInTheFileWhereTheyWereAskedFor) {
  Needs needs{Needs::Targets::truth};
  const auto without = demonstrate(*environment, scenes(2), needs, {"u"});
  environment->show_shadows(needs.shadows = true);
  const auto with = demonstrate(*environment, scenes(2), needs, {"u"});
  environment->show_shadows(false);
  const auto read = read_demonstrations(bytes(with), "d.hdf5");
  for (std::size_t i = 0; i < read.size(); ++i) {
    const Observation& seen = read[i].steps.front().observation;
    EXPECT_EQ(seen.shadows, with[i].steps.front().observation.shadows);
    EXPECT_GT(std::count_if(seen.shadows.begin(), seen.shadows.end(), [](auto bits) { return bits != 0; }), 100);
    EXPECT_EQ(seen.rgb, without[i].steps.front().observation.rgb);
  }
  EXPECT_TRUE(read_demonstrations(bytes(without), "d.hdf5").front().steps.front().observation.shadows.empty());
}

TEST_F(Play, FileReadsBackAsItWasWritten) {
  const auto before = demonstrations(3, 2);
  write_file(path / "d.hdf5", bytes(before));
  const auto after = read_demonstrations(read_file(path / "d.hdf5"), (path / "d.hdf5").string());
  ASSERT_EQ(after.size(), before.size());
  EXPECT_EQ(bytes(after), bytes(before));
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i].instruction.utterance, "Bring me the heart.");
    ASSERT_EQ(after[i].steps.size(), 1u);
    ASSERT_EQ(after[i].recovery.size(), before[i].recovery.size());
    for (std::size_t t = 0; t <= after[i].recovery.size(); ++t) {
      const Step &a = t == 0 ? after[i].steps[0] : after[i].recovery[t - 1],
                 &b = t == 0 ? before[i].steps[0] : before[i].recovery[t - 1];
      EXPECT_EQ(a.observation.rgb, b.observation.rgb);
      EXPECT_EQ(a.observation.ids, b.observation.ids);
      EXPECT_EQ(a.observation.instances.size(), b.observation.instances.size());
      EXPECT_EQ(a.observation.instances.back().texture, b.observation.instances.back().texture);
      EXPECT_EQ(a.label, b.label) << "to the last bit: cached trains as fresh";
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
      read_demonstrations(read_file(path / "d.hdf5"), (path / "d.hdf5").string());
    } catch (const InputError& e) {
      ++refused;
      EXPECT_EQ(std::string(e.what()).find((path / "d.hdf5").string()), 0u) << e.what();
    }
  }
  EXPECT_GT(refused, 50);
}

// Sets one byte of a file: `offset` bytes behind the start of the first place that holds `what`.
std::string damaged(std::string file, const std::string& what, std::size_t offset, char value) {
  const auto place = file.find(what);
  EXPECT_NE(place, std::string::npos);
  file[place + offset] = value;
  return file;
}

std::string refusal(const std::string& file) {
  try {
    read_demonstrations(file, "d.hdf5");
  } catch (const InputError& e) {
    return e.what();
  }
  return "read";
}

TEST_F(Play, SizesOfADamagedFileAreRefusedBeforeTheyAreAllocated) {
  const auto demonstration = demonstrations(1);
  const std::string good = bytes(demonstration);
  const std::string unsigned_byte("\x10\0\0\0\1\0\0\0\0\0\x08\0", 12);  // an HDF5 datatype message
  EXPECT_NE(refusal(damaged(good, unsigned_byte, 7, 0x10)).find("of another type"), std::string::npos);

  const PictureSize size = demonstration.front().steps.front().observation.size;
  std::string dimensions;
  for (const std::size_t n : {demonstration.front().steps.size(), static_cast<std::size_t>(size.rows),
                              static_cast<std::size_t>(size.columns), std::size_t{3}})
    for (std::size_t i = 0; i < 8; ++i) dimensions += static_cast<char>(n >> (8 * i) & 0xff);
  const std::string taller = damaged(good, dimensions, 8 + 2, 0x7f);  // some 8 million rows
  EXPECT_NE(refusal(damaged(taller, dimensions.substr(16), 2, 0x7f)).find("expected the shape"), std::string::npos);
}

TEST_F(Play, CacheIsTheSameAsNoCache) {
  const DemonstrationCache cache{path / "cache", {{"engine", "1"}}, "test"};
  const Needs needs{Needs::Targets::truth, 1, .2};
  const auto cached = [&](int n, const Json& builds) {
    std::vector<int> done;
    const DemonstrationCache with{cache.directory, builds, "test"};
    auto all = cached_demonstrations(with, *environment, scenes(n), needs, {"u"}, [&](int k) { done.push_back(k); });
    EXPECT_EQ(done.back(), n);
    return bytes(all);
  };
  const auto files = [&] { return std::distance(fs::directory_iterator(cache.directory), fs::directory_iterator()); };
  const std::string fresh = bytes(demonstrate(*environment, scenes(15), needs, {"u"}));
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
  for (int i = 0; i < n; ++i) all.push_back({test_scene(scenario, "cells", "test", 0, i)});
  return all;
}

int successes(const std::vector<Episode>& episodes) {
  return static_cast<int>(
      std::count_if(episodes.begin(), episodes.end(), [](const Episode& e) { return e.failure == failure::none; }));
}

TEST_F(Play, ReferenceRows) {
  const auto scenes = tests(*scenario, 60);
  EXPECT_EQ(successes(evaluate(*environment, scenes, reference_actor("oracle"), [](int) {})), 60);
  const auto random = evaluate(*environment, scenes, reference_actor("random_object"), [](int) {});
  // One or two distractors with equal odds: 5/12 expected; 4 sigma of 60 is 15.
  EXPECT_NEAR(successes(random), 25, 15);
  std::set<Failure> kinds;
  for (const Episode& e : random) kinds.insert(e.failure);
  EXPECT_EQ(kinds, (std::set<Failure>{failure::none, "wrong_object"})) << "it always takes something";
  EXPECT_THROW(reference_actor("nothing"), InputError);
}

TEST(ReferenceRows, EachActsAsAMethodOrByARule) {
  for (const ReferenceRow& row : reference_rows())
    EXPECT_NE(reference_method(row.id) != nullptr, static_cast<bool>(reference_actor(row.id).choose)) << row.id;
}

TEST_F(Play, ReferenceRowsThatHearNoCommandFindTheTargetWhereTheSceneGivesItAway) {
  const auto scenes_with = [](const char* member) {
    Json json = load_scenario("red_heart").json;
    json["tests"] = Json::array({{{"arm", "test"}, {"distractors", {2, 2}}, {member, true}}});
    return tests(read_scenario(json, "red_heart"), 60);
  };
  const auto of = [&](const std::vector<TestScene>& scenes, const Actor& actor) {
    return successes(evaluate(*environment, scenes, actor, [](int) {}));
  };
  const std::vector<TestScene> hard = scenes_with("hard"), near = scenes_with("near_miss");
  EXPECT_GT(of(hard, reference_actor("most_shared")), 28) << "the target alone shares both, half of the time";
  EXPECT_NEAR(of(near, reference_actor("most_shared")), 20, 15) << "all three share alike; 4 sigma of 60 is 15";
  DemonstratedScenes played;
  for (const TestScene& test : near) played.scenes.push_back(test.scene);
  EXPECT_EQ(of(near, reference_actor("never_demonstrated", played)), 0) << "every target was demonstrated";
  EXPECT_NEAR(of(near, reference_actor("never_demonstrated")), 20, 15);
  EXPECT_EQ(of(near, reference_actor("most_demonstrated", played)), 60) << "a near miss lacks one of its features";
  EXPECT_EQ(of(near, reference_actor("least_demonstrated", played)), 0);
  EXPECT_NEAR(of(near, reference_actor("most_demonstrated")), 20, 15) << "all are equal";
  EXPECT_NEAR(of(near, reference_actor("least_demonstrated")), 20, 15);
}

TEST_F(Play, MostDemonstratedCountsWhatTheScenesCommandTook) {
  Json json = load_scenario("red_heart").json;
  json["tests"] = Json::array({{{"arm", "test"}, {"distractors", {2, 2}}, {"near_miss", true}}});
  Scene scene = tests(read_scenario(json, "red_heart"), 1).front().scene;
  const Observation seen = environment->reset(scene);
  std::vector<SceneObject> objects;  // the target, and two others
  for (const SceneObject& object : scene.objects)
    if (object.role != role::goal) objects.push_back(object);
  std::stable_partition(objects.begin(), objects.end(), [](const SceneObject& o) { return o.role == role::target; });
  objects[1] = {"star", "blue", role::distractor, {}, 0, objects[1].instance_id};
  objects[2] = {"ring", "tiger", role::distractor, {}, 0, objects[2].instance_id};
  Observation labelled = seen;  // no two share a feature
  for (Instance& one : labelled.instances)
    for (const SceneObject& object : objects)
      if (one.id == object.instance_id) one.object_type = object.object_type, one.texture = object.texture;
  DemonstratedScenes shown;
  const auto took = [&](int command, std::size_t object) {
    SceneObject taken = objects[object];
    taken.role = role::target;
    shown.scenes.emplace_back();
    shown.scenes.back().command = command;
    shown.scenes.back().objects = {taken};
  };
  took(0, 1);
  took(1, 0);
  took(1, 0);
  const auto takes = [&](const char* row, int command, std::size_t object) {
    scene.command = command;
    return reference_actor(row, shown).act(*environment, scene, labelled).action ==
           environment->expert_action_for(objects[object].instance_id);
  };
  EXPECT_TRUE(takes("most_demonstrated", 0, 1));
  EXPECT_TRUE(takes("most_demonstrated", 1, 0));
  EXPECT_TRUE(takes("most_demonstrated", 2, 0)) << "nobody demonstrated it: what all took most often";
  for (const int command : {0, 1, 2}) EXPECT_TRUE(takes("least_demonstrated", command, 2));
  // Nothing that was taken is in view; a letter with stripes is likest in name to another one.
  shown.scenes.clear();
  SceneObject letter = objects[0];
  letter.object_type = "letter A";
  letter.texture = "red and yellow stripe";
  shown.scenes.emplace_back();
  shown.scenes.back().objects = {letter};
  for (const std::size_t like : {0, 1, 2}) {
    for (Instance& one : labelled.instances)
      for (std::size_t i = 0; i < objects.size(); ++i)
        if (one.id == objects[i].instance_id) {
          one.object_type = i == like ? "letter V" : "ring";
          one.texture = i == like ? "blue and purple stripe" : "tiger";
        }
    EXPECT_TRUE(takes("most_alike_names", 0, like)) << like;
  }
}

TEST(ReferenceRows, LikenessInNameIsOfMeansAndCounts) {
  const std::map<std::string, std::vector<float>> vectors{
      {"a", {1, 0}}, {"b", {.6f, .8f}}, {"c", {-1, 0}}, {"x", {0, 1}}, {"y", {0, 1}}};
  const EmbeddingOf embedding = [&](const std::string& name) -> const std::vector<float>& { return vectors.at(name); };
  const auto likeness = [&](const char* type, const char* texture, const TakenLooks& taken) {
    Instance one;
    one.object_type = type;
    one.texture = texture;
    return alike_in_name(one, taken, embedding);
  };
  const TakenLooks taken{{{"a", "x"}, {"b", "x"}}};
  EXPECT_NEAR(likeness("a", "x", taken), 1.5 * .8 * 2.5 * 1, 1e-6);
  EXPECT_NEAR(likeness("a", "y", taken), 1.5 * .8 * .5 * 1, 1e-6) << "means the same, and was not taken";
  EXPECT_EQ(likeness("c", "x", taken), 0) << "the contrary";
  EXPECT_EQ(likeness("a", "x", {}), .25);
}

TEST(ReferenceRows, LeadToTheReceiverThatWasDemonstrated) {
  const Scenario scenario = load_scenario("fetch_fruit");
  const auto environment = make_environment(scenario, make_engine());
  for (int i = 0; i < 5; ++i) {
    const Scene scene = test_scene(scenario, "table", "few", 0, i);
    const Observation seen = environment->reset(scene);
    Scene elsewhere = scene;  // led to another receiver
    for (SceneObject& object : elsewhere.objects)
      if (object.role == "receiver")
        object.role = role::distractor;
      else if (object.role == role::distractor && object.position_m.x > 1.1)
        object.role = "receiver";
    for (const Scene& shown : {scene, elsewhere}) {
      const SceneObject* const receiver = shown.find("receiver");
      const Action action = reference_actor("most_demonstrated", {{shown}, "receiver", actions_of(scenario)})
                                .act(*environment, scene, seen)
                                .action;
      ASSERT_EQ(action.size(), 8u);
      EXPECT_NEAR(action[6], receiver->position_m.x, 1e-9) << i;
      EXPECT_NEAR(action[7], receiver->position_m.y, 1e-9) << i;
    }
  }
}

// A policy that fails in one way on every third scene and does nothing of use on the others.
class Sometimes : public Policy {
 public:
  explicit Sometimes(int way) : way_(way) {}
  void reset() override { ++resets; }
  Action act(const Observation&, const Instruction&) override {
    TwoPoses action;
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
  const std::vector<Instruction> instructions{{"u", {}}};
  for (int way = 0; way < 5; ++way) {
    Sometimes policy(way);
    const auto episodes =
        evaluate(*environment, tests(*scenario, 6), policy_actor(policy, instructions, "p"), [](int) {});
    ASSERT_EQ(episodes.size(), 6u);
    EXPECT_EQ(policy.resets, 6);
    for (std::size_t i = 0; i < 6; ++i) {
      const bool bad = i % 3 == 2;
      EXPECT_EQ(episodes[i].failure, bad ? failure::method_error : "missed_object") << way;
      EXPECT_EQ(episodes[i].error.empty(), !bad) << way;
      EXPECT_EQ(episodes[i].action.empty(), bad);
      EXPECT_EQ(to_json(episodes[i]).at("action").is_null(), bad);
    }
  }
}

// Says of every second input that it had learned from it.
class Telling : public Policy {
 public:
  Action act(const Observation&, const Instruction&) override {
    ++acts_;
    return TwoPoses{{{.5, 0}, {}}, {{.5, 0}, {}}};
  }
  std::optional<bool> seen_in_training() const override { return acts_ % 2 == 0; }

 private:
  int acts_ = 0;
};

TEST_F(Play, AnEpisodeKeepsWhetherItsInputStoodInTraining) {
  const std::vector<Instruction> instructions{{"u", {}}};
  Telling telling;
  Sometimes silent(0);
  const auto scenes = tests(*scenario, 3);
  const auto played = [&](Policy& policy) {
    return evaluate(*environment, scenes, policy_actor(policy, instructions, "p"), [](int) {});
  };
  auto episodes = played(telling);
  attribute_failures(*environment, scenes, policy_actor(telling, instructions, "p"), instructions, episodes);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(episodes[i].input_seen, i % 2 == 1) << "of the action that counts";
    EXPECT_EQ(to_json(episodes[i]).at("input_seen"), i % 2 == 1);
  }
  for (const Episode& e : played(silent)) EXPECT_FALSE(to_json(e).contains("input_seen"));
}

TEST_F(Play, WithoutAnAbstractionAnEpisodeIsNotPlayed) {
  auto scenes = tests(*scenario, 4);
  scenes[2].abstraction_empty = true;
  const auto episodes = evaluate(*environment, scenes, reference_actor("oracle"), [](int) {});
  ASSERT_EQ(episodes.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(episodes[i].failure, i == 2 ? failure::abstraction_empty : failure::none);
  EXPECT_EQ(episodes[2].scene, hex(scenes[2].scene.hash()));
  EXPECT_TRUE(episodes[2].action.empty());
}

// Wins where the Selection it is told is that of `key`, else takes nothing.
class OnlyWith : public Policy {
 public:
  OnlyWith(FeatureSet key, std::function<Action()> oracle) : key_(std::move(key)), oracle_(std::move(oracle)) {}
  Action act(const Observation&, const Instruction& instruction) override {
    TwoPoses nothing;
    nothing.pose0.position_m = nothing.pose1.position_m = {.26, .49};
    return instruction.selection.target == key_ ? oracle_() : Action(nothing);
  }

 private:
  FeatureSet key_;
  std::function<Action()> oracle_;
};

TEST_F(Play, AFailureIsTheAbstractionsWhereTheTruthWouldHaveHelped) {
  const FeatureSet truth{{"heart"}, {"red"}}, other{{"star"}, {"red"}}, third{{"bowl"}, {"red"}};
  const auto attributions = [&](const FeatureSet& wins_with, const FeatureSet& told) {
    OnlyWith policy(wins_with, [] { return environment->expert_action(); });
    Selection selected, true_one;
    selected.target = told;
    true_one.target = truth;
    const std::vector<Instruction> instructions{{"u", selected}}, true_ones{{"u", true_one}};
    auto scenes = tests(*scenario, 3);
    scenes[2].abstraction_empty = true;
    auto episodes = evaluate(*environment, scenes, policy_actor(policy, instructions, "p"), [](int) {});
    EXPECT_TRUE(to_json(episodes[0]).at("attribution").is_null());
    attribute_failures(*environment, scenes, policy_actor(policy, instructions, "p"), true_ones, episodes);
    std::vector<std::string> all;
    for (const Episode& e : episodes) all.push_back(e.attribution);
    return all;
  };
  using Words = std::vector<std::string>;
  EXPECT_EQ(attributions(other, other), (Words{"", "", "abstraction"})) << "won, or nothing selected";
  EXPECT_EQ(attributions(truth, other), (Words{"abstraction", "abstraction", "abstraction"}));
  EXPECT_EQ(attributions(third, other), (Words{"policy", "policy", "abstraction"}));
}

// Wins where it sees anything.
class Seeing : public Policy {
 public:
  explicit Seeing(std::function<Action()> oracle) : oracle_(std::move(oracle)) {}
  Action act(const Observation& seen, const Instruction&) override {
    TwoPoses nothing;
    nothing.pose0.position_m = nothing.pose1.position_m = {.26, .49};
    return seen.instances.empty() ? Action(nothing) : oracle_();
  }

 private:
  std::function<Action()> oracle_;
};

TEST_F(Play, AFailureIsPerceptionsWhereThePolicySucceedsOnceItSees) {
  Seeing policy([] { return environment->expert_action(); });
  const std::vector<Instruction> instructions{{"u", {}}};
  auto scenes = tests(*scenario, 3);
  scenes[1].perception = [](Observation seen, const Scene&, int) {
    seen.instances.clear();
    std::fill(seen.ids.begin(), seen.ids.end(), std::uint8_t{0});
    return seen;
  };
  const Actor actor = policy_actor(policy, instructions, "p");
  auto episodes = evaluate(*environment, scenes, actor, [](int) {});
  attribute_failures(*environment, scenes, actor, instructions, episodes);
  std::vector<std::string> all;
  for (const Episode& e : episodes) all.push_back(e.attribution);
  EXPECT_EQ(all, (std::vector<std::string>{"", "perception", ""}));
  EXPECT_FALSE(perception_of(*scenario, scenario->tests.front())) << "no errors: the environment's observation itself";
}

// In the same picture, where only the names are read wrongly.
TEST_F(Play, AFailureIsTheReadingsWhereThePolicySucceedsWithTheSimulatorsNames) {
  Seeing policy([] { return environment->expert_action(); });
  const std::vector<Instruction> instructions{{"u", {}}};
  auto scenes = tests(*scenario, 3);
  const auto blind = [](Observation seen) {
    seen.instances.clear();
    std::fill(seen.ids.begin(), seen.ids.end(), std::uint8_t{0});
    return seen;
  };
  scenes[2].perception = [&](const Observation& seen, const Scene&, int) { return blind(seen); };
  Actor actor = policy_actor(policy, instructions, "p");
  actor.reads = [&](const Observation& seen, const Scene& scene) { return scene.index == 0 ? seen : blind(seen); };
  auto episodes = evaluate(*environment, scenes, actor, [](int) {});
  attribute_failures(*environment, scenes, actor, instructions, episodes);
  std::vector<std::string> all;
  for (const Episode& e : episodes) all.push_back(e.attribution);
  EXPECT_EQ(all, (std::vector<std::string>{"", "reading", "abstraction"})) << "the third: in neither picture";
}

// Takes note of what it is given.
class Witness : public Policy {
 public:
  Action act(const Observation& observation, const Instruction& instruction) override {
    utterances.push_back(instruction.utterance);
    observations.push_back(observation);
    return {};
  }
  std::vector<std::string> utterances;
  std::vector<Observation> observations;
};

TEST_F(Play, APolicyIsGivenTheCommandOfItsScene) {
  const Scenario fruit = load_scenario("q3_fruit");
  const auto household = make_environment(fruit, make_engine());
  std::vector<Instruction> instructions;
  for (const ScenarioCommand& command : fruit.commands) instructions.push_back({command.utterance, {}});
  std::vector<TestScene> scenes;
  for (const char* arm : {"seen", "unseen"})
    for (int i = 0; i < 3; ++i) scenes.push_back({test_scene(fruit, "cells", arm, 0, i)});
  Witness policy;
  const auto episodes = evaluate(*household, scenes, policy_actor(policy, instructions, "p"), [](int) {});
  const std::string tomato = "Bring me a tomato.", apple = "Bring me an apple.", any = "Bring me a fruit.";
  EXPECT_EQ(policy.utterances, (std::vector<std::string>{tomato, apple, tomato, any, any, any}));
  EXPECT_EQ(to_json(episodes[1]).at("command"), 1);
  EXPECT_EQ(to_json(episodes[3]).at("command"), 2);

  std::vector<Scene> shown;
  for (int i = 0; i < 4; ++i) shown.push_back(training_scene(fruit, "cells", {}, 0, i));
  const auto demonstrations = demonstrate(*household, shown, {}, {tomato, apple, any});
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(demonstrations[i].instruction.utterance, i % 2 ? apple : tomato);
    EXPECT_EQ(shown[i].objects.size(), 3u) << "the named one, a distractor and the pallet";
    EXPECT_EQ(shown[i].find(role::target)->object_type, i % 2 ? "apple" : "tomato");
  }
}

// Errors that all training seeds shared would be drawn once for all of them, and counted as if they were not.
TEST_F(Play, ATrainingSeedWithItsOwnScenesHasItsOwnErrors) {
  Arm arm = scenario->tests.front();
  arm.label_noise = .5;
  const auto types_with = [&](std::optional<std::uint64_t> seed) {
    std::vector<std::string> types;
    for (const TestScene& test : tests(*scenario, 10)) {
      const Observation seen = perception_of(*scenario, arm, seed)(environment->reset(test.scene), test.scene, 0);
      for (const Instance& instance : seen.instances) types.push_back(instance.object_type);
    }
    return types;
  };
  EXPECT_EQ(types_with(0), types_with(0));
  EXPECT_NE(types_with(0), types_with(1));
  EXPECT_NE(types_with(std::nullopt), types_with(0));
}

TEST_F(Play, ImperfectTextualizationChangesWhatAPolicySeesAndNothingElse) {
  const auto seen_with = [&](const TextualizationNoise& noise) {
    std::vector<TestScene> scenes = tests(*scenario, 20);
    Arm arm = scenario->tests.front();
    arm.label_noise = noise.label_noise;
    arm.missed_segment = noise.missed_segment;
    for (TestScene& scene : scenes) scene.perception = perception_of(*scenario, arm);
    Witness policy;
    const std::vector<Instruction> instructions{{"u", {}}};
    const auto episodes = evaluate(*environment, scenes, policy_actor(policy, instructions, "p"), [](int) {});
    for (std::size_t i = 0; i < episodes.size(); ++i) EXPECT_EQ(episodes[i].scene, hex(scenes[i].scene.hash()));
    return policy.observations;
  };
  const auto differing = [](const std::vector<Observation>& a, const std::vector<Observation>& b) {
    int labels = 0, pixels = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].rgb, b[i].rgb);
      pixels += a[i].ids != b[i].ids;
      for (std::size_t k = 0; k < std::min(a[i].instances.size(), b[i].instances.size()); ++k)
        labels += a[i].instances[k].object_type != b[i].instances[k].object_type ||
                  a[i].instances[k].texture != b[i].instances[k].texture;
    }
    return std::pair{labels, pixels};
  };
  const auto clean = seen_with({});
  EXPECT_EQ(differing(clean, seen_with({})), (std::pair{0, 0}));
  const auto [labels, no_pixels] = differing(clean, seen_with({.5, 0}));
  EXPECT_GT(labels, 20);
  EXPECT_EQ(no_pixels, 0);
  EXPECT_GT(differing(clean, seen_with({0, .5})).second, 10);
}

TEST(Constant, IsTheMedoidOfTheLabels) {
  std::vector<Demonstration> demonstrations;
  for (const double y : {.4, -.1, 0.0, .05, -.3}) {
    TwoPoses action;
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
  Services services{lm, human, options, 0, log, tabletop::two_poses()};
  // Summed distances: .4 1.85, -.1 .95, 0 .85, .05 .90, -.3 1.55
  EXPECT_EQ(method.learn(demonstrations, services)->act({}, {})[1], 0);
  EXPECT_THROW(method.learn({}, services), MethodError);
}

TEST(Pictures, LoseTheirFinestColoursWhereTheyAreTooLarge) {
  Picture picture(64, 64);
  picture.paste(0, 0, 64, 64, 1, [](int x, int y) {
    const auto noise = static_cast<std::uint8_t>(17 * x * x + 29 * y * y + 7 * x * y);
    return Rgb{noise, static_cast<std::uint8_t>(3 * noise), static_cast<std::uint8_t>(5 * noise)};
  });
  const std::size_t whole = picture.png().size();
  EXPECT_EQ(picture.png(whole), picture.png());
  const std::string smaller = picture.png(whole - 1);
  EXPECT_LT(smaller.size(), whole);
  EXPECT_GT(smaller.size(), picture.png(1).size()) << "no more is lost than need be";
}

}  // namespace
}  // namespace lgabench
