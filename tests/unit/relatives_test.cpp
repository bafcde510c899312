// What the rows after other papers claim to do to a picture, found in what their policies have learned from and read.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/repaint.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/learning/inputs.hpp>
#include <lgabench/plugin/loader.hpp>

#include "../engine_under_test.hpp"
#include "testing.hpp"

namespace lgabench {
namespace {

struct Silent : TrainingLog {
  void epoch(int, long long steps, double) override { last = steps; }
  long long last = 0;
};

// A command, demonstrations of its truth, a row that learns from them, and another scene.
class Relatives : public testing::Test {
 protected:
  static constexpr std::uint64_t seed = 5;

  std::unique_ptr<Policy> learned(const std::string& id, Json options) {
    const PluginInfo& plugin = catalogue.find("method", id);
    options["epochs"] = 1;
    const Json all = resolve_options(plugin, options);
    method = load_method(plugin);
    EXPECT_EQ(method->needs(all).shadows,
              id == "masked_bc" || id == "texture_aug" || id == "object_dropout" || id == "erase");
    RecordedLanguageModel lm(scenario, scenario.recorded);
    TruthAsHuman human(scenario.commands);
    Services services{lm, human, all, seed, log, find_environment("tabletop").action_space()};
    auto policy = method->learn(demonstrations, services);
    method.reset();  // a policy outlives it
    return policy;
  }
  // Whether the policy was trained on exactly that picture.
  bool learned_from(Policy& policy, const Observation& seen) {
    policy.act(seen, instruction);
    return *policy.seen_in_training();
  }
  RandomStream stream(int row, int copy) const {
    return RandomStream(fmt::format("learning/augment/{}/{}/{}", seed, row, copy));
  }
  // The pictures that the last act() read, rgb first.
  static std::vector<std::uint8_t> read_by(const Policy& policy) { return policy.shown().pictures.at(0).rgb; }

  Relatives() {
    const auto environment = make_environment(scenario, make_engine());
    environment->show_shadows(true);
    for (int i = 0; i < 4; ++i) {
      const Scene shown = training_scene(scenario, "continuous", {}, 1, i);
      Observation seen = environment->reset(shown);
      demonstrations.push_back({instruction, {{std::move(seen), environment->expert_action()}}});
    }
    probe = environment->reset(test_scene(scenario, "continuous", scenario.tests.front().id, 0, 0));
    others = unselected(probe, instruction.selection);
  }

  const Catalogue catalogue = scan_plugins({shipped_plugin_directory()});
  const Scenario scenario = load_scenario("heart");
  const Instruction instruction{scenario.commands.front().utterance, scenario.commands.front().truth};
  std::vector<Demonstration> demonstrations;
  Observation probe;
  Ids others;
  std::unique_ptr<Method> method;
  Silent log;
};

TEST_F(Relatives, CopiesAreWhatTheRowsSay) {
  const auto step = [&](int row) { return demonstrations[static_cast<std::size_t>(row)].steps.front().observation; };
  const auto masked = learned("masked_bc", {{"copies", 2}}), textured = learned("texture_aug", {{"copies", 2}}),
             dropped = learned("object_dropout", {{"copies", 2}});
  const Background usual = usual_background(demonstrations);
  for (int row = 0; row < 4; ++row) {
    for (Policy* policy : {masked.get(), textured.get(), dropped.get()}) EXPECT_TRUE(learned_from(*policy, step(row)));
    for (int copy = 0; copy < 2; ++copy) {
      RandomStream noise = stream(row, copy), patterns = stream(row, copy), coins = stream(row, copy);
      Ids which = unselected(step(row), instruction.selection);
      EXPECT_TRUE(learned_from(*masked, repaint(step(row), which, Noise{noise})));
      which.push_back(0);
      EXPECT_TRUE(learned_from(*textured, repaint(step(row), which, RandomTextures{patterns})));
      Ids missing;
      for (const Instance& instance : step(row).instances)
        if (coins.coin()) missing.push_back(instance.id);
      EXPECT_TRUE(learned_from(*dropped, repaint(step(row), missing, usual)));
    }
  }
  EXPECT_FALSE(learned_from(*masked, probe));
}

TEST_F(Relatives, TakeNoMoreStepsUnlessToldTo) {
  learned("masked_bc", {{"copies", 5}, {"batch_size", 2}});
  EXPECT_EQ(log.last, 2);
  learned("masked_bc", {{"copies", 5}, {"batch_size", 2}, {"copy_steps", "all"}});
  EXPECT_EQ(log.last, 12);
}

TEST_F(Relatives, ErasedObjectsAreGoneWhereTheRowSaysSo) {
  const Observation without = repaint(probe, others, usual_background(demonstrations));
  const auto policy = [&](const char* when) { return learned("erase", {{"when", when}}); };
  for (const auto& [when, erases] : {std::pair("train", false), std::pair("test", true), std::pair("both", true)}) {
    const auto erase = policy(when);
    erase->act(probe, instruction);
    const std::vector<std::uint8_t> read = read_by(*erase);
    erase->act(without, instruction);  // where nothing is left to erase but what changes nothing
    EXPECT_EQ(read == read_by(*erase), erases) << when;
    const Observation& shown = demonstrations.front().steps.front().observation;
    const Observation erased =
        repaint(shown, unselected(shown, instruction.selection), usual_background(demonstrations));
    // What was learned from is asked with what is not erased again: an observation of the target alone.
    EXPECT_EQ(learned_from(*erase, erased), std::string(when) != "test") << when;
  }
}

TEST_F(Relatives, AGateErasesWhatTheActionIsSensitiveTo) {
  const auto open = learned("erase", {{"when", "gated"}, {"threshold", 0.}}),
             shut = learned("erase", {{"when", "gated"}, {"threshold", 10.}});
  open->act(probe, instruction);
  const auto erased = read_by(*open);
  shut->act(probe, instruction);
  EXPECT_NE(erased, read_by(*shut));
  const Observation without = repaint(probe, others, usual_background(demonstrations));
  shut->act(without, instruction);
  EXPECT_EQ(erased, read_by(*shut));
}

TEST_F(Relatives, WhatWasTakenIsSelectedOfTheCommandsOwnDemonstrations) {
  const FeatureSpace& space = scenario.space;
  const ActionSpace& actions = find_environment("tabletop").action_space();
  std::set<std::string> types, textures;
  for (const Demonstration& one : demonstrations)
    for (const Instance& instance : one.steps.front().observation.instances)
      if (instance.id == taken(one, actions)) types.insert(instance.object_type), textures.insert(instance.texture);
  ASSERT_EQ(types, std::set<std::string>{"heart"});
  ASSERT_GT(textures.size(), 1u);
  std::vector<Demonstration> shown = demonstrations;
  shown.back().instruction.utterance = "Another.";
  const std::string of_other = "Another.", of_none = "Nobody showed this.";
  const auto revised = [&](const char* id, const std::string& utterance, const std::optional<Meaning>& selected) {
    const PluginInfo& plugin = catalogue.find("method", id);
    const Json all = resolve_options(plugin, Json::object());
    method = load_method(plugin);
    EXPECT_TRUE(method->needs(all).revise);
    RecordedLanguageModel lm(scenario, scenario.recorded);
    TruthAsHuman human(scenario.commands);
    Services services{lm, human, all, seed, log, actions};
    Selection first = method->select({instruction.utterance, scenario.task}, space, services);
    if (selected) first.target = *selected;
    return method->revise({utterance, scenario.task}, first, shown, services).target;
  };
  const auto contains = [](const std::vector<std::string>& all, const std::string& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
  };
  const std::string& last = [&]() -> const std::string& {
    for (const Instance& instance : shown.back().steps.front().observation.instances)
      if (instance.id == taken(shown.back(), actions)) return instance.texture;
    throw Error("nothing was taken");
  }();
  EXPECT_EQ(revised("taken_features", of_other, {}), Meaning({"heart"}, {last}));
  const FeatureSet of_all = revised("taken_features", of_none, {}).product();
  EXPECT_EQ(of_all.object_types, std::vector<std::string>{"heart"});
  EXPECT_EQ(std::set<std::string>(of_all.textures.begin(), of_all.textures.end()), textures);

  const Meaning star({"star"}, {"tiger"});
  const FeatureSet both = revised("lga_taken", of_other, star).product();
  EXPECT_EQ(both.object_types.size(), 2u);
  for (const char* type : {"heart", "star"}) EXPECT_TRUE(contains(both.object_types, type));
  for (const std::string& texture : {std::string("tiger"), last}) EXPECT_TRUE(contains(both.textures, texture));
  EXPECT_EQ(revised("lga_taken", of_none, star), star) << "what others took says nothing of it";
  Meaning two = star;
  two.sets.push_back({{"ring"}, {"tiger"}});
  const Meaning three = revised("lga_taken", of_other, two);
  ASSERT_EQ(three.sets.size(), 3u);
  EXPECT_EQ(three.sets.back(), (FeatureSet{{"heart"}, {last}}));
}

#if defined(LGABENCH_HAS_DIFFUSION)
TEST_F(Relatives, DiffusionActsTheSameWhateverItSawBeforeAndMovesWithTheMask) {
  for (const char* input : {"mask", "object_mask", "rgb"}) {
    const auto policy = learned("diffusion", {{"updates", 30}, {"input", input}}),
               again = learned("diffusion", {{"updates", 30}, {"input", input}});
    const Action first = policy->act(probe, instruction);
    EXPECT_EQ(first, again->act(probe, instruction));
    const Observation other = demonstrations.front().steps.front().observation;
    EXPECT_NE(policy->act(other, instruction), first) << input;
    EXPECT_EQ(policy->act(probe, instruction), first) << input;
    const Action label = demonstrations.front().steps.front().label;
    for (const std::size_t copied : {2u, 9u, 10u})
      EXPECT_NEAR(first[copied], label[copied], 1e-3) << "heights, no tilt";
    EXPECT_EQ(executable(find_environment("tabletop").action_space(), first).size(), first.size());
  }
}
#endif

TEST_F(Relatives, OfMaskedColoursOneIsLeftBesideTheTarget) {
  const auto policy = learned("masked_rgb", Json::object());
  Observation bare = probe;
  bare.shadows.clear();  // as the row has them
  policy->act(bare, instruction);
  const std::vector<std::uint8_t> read = read_by(*policy), mask = goal_mask(probe, instruction.selection);
  std::vector<float> small(static_cast<std::size_t>(input_pixels));
  shrink_mask(mask, probe.size, input_size, small.data());
  std::set<std::vector<std::uint8_t>> colours;
  int kept = 0;
  for (std::size_t i = 0; i < small.size(); ++i) {
    if (small[i] == 0)
      colours.insert({read[3 * i], read[3 * i + 1], read[3 * i + 2]});
    else
      ++kept;
  }
  EXPECT_EQ(colours.size(), 1u);
  EXPECT_GT(kept, 5);
}

TEST_F(Relatives, EarlyFusionSeesMaskAndPictureWithThePapersNetworkAlone) {
  const auto early = learned("lga_s", {{"fusion", "early"}}), late = learned("lga_s", Json::object());
  const Action action = early->act(probe, instruction);
  EXPECT_NE(action, late->act(probe, instruction));
  EXPECT_LT(early->saved()->size(), late->saved()->size()) << "one tower in place of two";
  Instruction other = instruction;
  other.selection.target = {{"star"}, {"no such texture"}};
  EXPECT_NE(early->act(probe, other), action) << "a mask of nothing";
  Observation dark = probe;
  for (std::uint8_t& value : dark.rgb) value /= 2;
  EXPECT_NE(early->act(dark, instruction), action);
  EXPECT_THROW(learned("lga_s", {{"fusion", "early"}, {"policy", "heat_map"}}), InputError);
}

TEST_F(Relatives, ASetNetworkTakesWhatIsSelectedWhereverItLies) {
  const auto policy = learned("set_network", Json::object());
  const Action first = policy->act(probe, instruction);
  Instruction other = instruction;
  const auto another = std::find_if(probe.instances.begin(), probe.instances.end(),
                                    [&](const Instance& i) { return i.id == others.front(); });
  other.selection.target = {{another->object_type}, {another->texture}};
  const Action second = policy->act(probe, other);
  EXPECT_GT(std::hypot(first[0] - second[0], first[1] - second[1]), .05) << "another object is selected";
  Observation permuted = probe;
  std::rotate(permuted.instances.begin(), permuted.instances.begin() + 1, permuted.instances.end());
  EXPECT_EQ(policy->act(permuted, instruction), first) << "the order of the table says nothing";
}

}  // namespace
}  // namespace lgabench
