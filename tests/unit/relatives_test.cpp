// What the rows after other papers claim to do to a picture, found in what their policies have learned from and read.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/repaint.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/stations.hpp>
#include <lgabench/learning/inputs.hpp>
#include <lgabench/plugin/loader.hpp>

#include "../../baselines/class_copies.hpp"
#include "../../baselines/taken_features.hpp"
#include "../engine_under_test.hpp"
#include "testing.hpp"

namespace lgabench {
namespace {

struct Silent : TrainingLog {
  void epoch(int, long long steps, double) override { last = steps; }
  long long last = 0;
};

std::vector<Demonstration> demonstrations_of(const Scenario& scenario) {
  const Instruction instruction{scenario.commands.front().utterance, scenario.commands.front().truth};
  const auto environment = make_environment(scenario, make_engine());
  environment->show_shadows(true);
  std::vector<Demonstration> all;
  for (int i = 0; i < 4; ++i) {
    Observation seen = environment->reset(training_scene(scenario, "continuous", {}, 1, i));
    all.push_back({instruction, {{std::move(seen), environment->expert_action()}}});
  }
  return all;
}

// A command, demonstrations of its truth, a row that learns from them, and another scene.
class Relatives : public testing::Test {
 protected:
  static constexpr std::uint64_t seed = 5;

  std::unique_ptr<Policy> learned(const std::string& id, Json options) {
    const PluginInfo& plugin = catalogue.find("method", id);
    options["epochs"] = 1;
    const Json all = resolve_options(plugin, options);
    method = load_method(plugin);
    const std::set<std::string> repaint{"masked_bc", "texture_aug", "class_aug", "object_dropout", "erase"};
    EXPECT_EQ(method->needs(all).shadows, repaint.count(id) == 1);
    RecordedLanguageModel lm(scenario, scenario.recorded);
    TruthAsHuman human(scenario.commands);
    Services services{lm, human, all, seed, log, find_environment("tabletop").action_space()};
    method->select({instruction.utterance, scenario.task}, scenario.space, services);
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

  Relatives() : demonstrations(demonstrations_of(scenario)) {
    const auto environment = make_environment(scenario, make_engine());
    environment->show_shadows(true);
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

TEST_F(Relatives, CopiesHaveMoreOfTheSelectedClass) {
  const auto policy = learned("class_aug", {{"copies", 4}});
  const ClassCopies of_class(demonstrations, find_environment("tabletop").action_space(), scenario.space.textures);
  for (int row = 0; row < 4; ++row)
    for (int copy = 0; copy < 4; ++copy) {
      Step step = demonstrations[static_cast<std::size_t>(row)].steps.front();
      RandomStream draws = stream(row, copy);
      if (copy % 2 == 0)
        of_class.another_look(step, instruction.selection.target, draws);
      else
        of_class.another_member(step, instruction.selection.target, draws);
      EXPECT_TRUE(learned_from(*policy, step.observation)) << row << " " << copy;
    }
}

TEST_F(Relatives, LooksAreThoseThatAreSelectedWithTheTargetsType) {
  const ActionSpace& actions = find_environment("tabletop").action_space();
  const ClassCopies of_class(demonstrations, actions, scenario.space.textures);
  const Step& step = demonstrations.front().steps.front();
  const std::uint8_t target = *taken(demonstrations.front(), actions);
  std::string texture;
  std::vector<Instance> others;  // in other textures than it and each other
  std::set<std::string> met;
  for (const Instance& instance : step.observation.instances)
    if (instance.id == target) met.insert(texture = instance.texture);
  for (const Demonstration& one : demonstrations)
    for (const Instance& instance : one.steps.front().observation.instances)
      if (instance.object_type != "heart" && !is_place(instance.object_type) && met.insert(instance.texture).second)
        others.push_back(instance);
  ASSERT_GE(others.size(), 2u);
  std::set<Colour> allowed;  // of what has the one texture that is selected with the type
  for (const Demonstration& one : demonstrations) {
    const Observation& seen = one.steps.front().observation;
    for (const Instance& instance : seen.instances)
      for (std::size_t i = 0; i < seen.ids.size() && instance.texture == others[0].texture; ++i)
        if (seen.ids[i] == instance.id) allowed.insert({seen.rgb[3 * i], seen.rgb[3 * i + 1], seen.rgb[3 * i + 2]});
  }
  Meaning pairs({"heart"}, {texture, others[0].texture});
  pairs.sets.push_back({{others[1].object_type}, scenario.space.textures});
  for (int i = 0; i < 20; ++i) {
    Step copy = step;
    RandomStream draws = stream(0, i);
    of_class.another_look(copy, pairs, draws);
    EXPECT_EQ(copy.label, step.label);
    int changed = 0;
    for (std::size_t p = 0; p < step.observation.ids.size(); ++p) {
      const std::uint8_t *before = &step.observation.rgb[3 * p], *after = &copy.observation.rgb[3 * p];
      const bool of_target = step.observation.ids[p] == target;
      const bool differs = !std::equal(before, before + 3, after);
      changed += differs;
      EXPECT_TRUE(of_target || !differs);
      EXPECT_TRUE(!of_target || allowed.count({after[0], after[1], after[2]}));
    }
    EXPECT_GT(changed, 50);
  }
  const auto repainted = [&](const Meaning& meaning) {
    Step copy = step;
    RandomStream draws = stream(0, 0);
    of_class.another_look(copy, meaning, draws);
    return copy.observation.rgb;
  };
  RandomStream draws = stream(0, 0);
  EXPECT_EQ(repainted({{"heart"}, scenario.space.textures}),
            repaint(step.observation, {target}, RandomTextures{draws}).rgb);
  EXPECT_EQ(repainted({{"heart"}, {texture}}), step.observation.rgb) << "no other texture";
  EXPECT_EQ(repainted({{"star"}, scenario.space.textures}), step.observation.rgb) << "of another type";
}

// Whether `copy` is `step` without its target and with what `member` took, moved by whole pixels to where nothing
// stands, as its label is, of which so many places move.
bool is_moved(const Step& copy, const Demonstration& of_step, const Demonstration& member, const Background& usual,
              std::size_t places) {
  const ActionSpace& actions = find_environment("tabletop").action_space();
  const Step &step = of_step.steps.front(), &from = member.steps.front();
  const std::uint8_t gone = *taken(of_step, actions), id = *taken(member, actions);
  const PictureSize size = step.observation.size;
  const auto pixels = [&](std::size_t number, int side) {
    const ActionNumber& of = actions.numbers[number];
    return (copy.label[number] - from.label[number]) / (of.high - of.low) * side;
  };
  const double down = pixels(0, size.rows), across = pixels(1, size.columns);
  const long rows = std::lround(down), columns = std::lround(across);
  if (std::abs(down - double(rows)) > 1e-6 || std::abs(across - double(columns)) > 1e-6) return false;
  Action label = from.label;
  for (std::size_t i = 0; i < places; ++i) {
    label[actions.places[i].down] += copy.label[0] - from.label[0];
    label[actions.places[i].across] += copy.label[1] - from.label[1];
  }
  for (std::size_t i = 0; i < label.size(); ++i)
    if (std::abs(label[i] - copy.label[i]) > 1e-9) return false;
  Observation expected = repaint(step.observation, {gone}, usual);
  for (int i = 0; i < static_cast<int>(size.pixels()); ++i) {
    if (from.observation.ids[static_cast<std::size_t>(i)] != id) continue;
    const long row = i / size.columns + rows, column = i % size.columns + columns;
    if (row < 0 || column < 0 || row >= size.rows || column >= size.columns) return false;
    const auto to = static_cast<std::size_t>(row * size.columns + column);
    if (step.observation.ids[to] != 0 && step.observation.ids[to] != gone) return false;
    std::copy_n(&from.observation.rgb[3 * static_cast<std::size_t>(i)], 3, &expected.rgb[3 * to]);
  }
  return expected.rgb == copy.observation.rgb;
}

TEST_F(Relatives, MembersStandWhereNothingStoodAndTheirLabelsWithThem) {
  for (const auto& [id, places] : {std::pair("heart", 1u), std::pair("rotate_block", 2u)}) {
    const Scenario task = load_scenario(id);
    const std::vector<Demonstration> shown = demonstrations_of(task);
    const ClassCopies of_class(shown, find_environment("tabletop").action_space(), task.space.textures);
    const Background usual = usual_background(shown);
    std::set<std::size_t> members;
    std::set<Action> labels;
    for (int i = 0; i < 20; ++i) {
      const Demonstration& of = shown[static_cast<std::size_t>(i) % shown.size()];
      const auto put = [&](const Meaning& meaning) {
        Step copy = of.steps.front();
        RandomStream draws = stream(0, i);
        of_class.another_member(copy, meaning, draws);
        return copy;
      };
      const Step copy = put(of.instruction.selection.target), again = put(of.instruction.selection.target);
      EXPECT_EQ(copy.label, again.label);
      EXPECT_EQ(copy.observation.rgb, again.observation.rgb);
      std::size_t found = shown.size();
      for (std::size_t member = 0; member < shown.size(); ++member)
        if (is_moved(copy, of, shown[member], usual, places)) found = member;
      EXPECT_LT(found, shown.size()) << id << " " << i;
      members.insert(found);
      labels.insert(copy.label);
      EXPECT_EQ(put({{"no such type"}, task.space.textures}).observation.rgb, of.steps.front().observation.rgb);
    }
    EXPECT_EQ(members.size(), shown.size());
    EXPECT_EQ(labels.size(), 20u);
  }
}

TEST_F(Relatives, AClassIsNotMovedWhereThatChangesWhatIsMeant) {
  const PluginInfo& plugin = catalogue.find("method", "class_aug");
  const auto refusal = [&](const char* id, const char* meaning) {
    const Scenario of = load_scenario(id);
    const Json all = resolve_options(plugin, {{"meaning", meaning}});
    method = load_method(plugin);
    RecordedLanguageModel lm(of, of.recorded);
    TruthAsHuman human(of.commands);
    Services services{lm, human, all, seed, log, find_environment("tabletop").action_space()};
    return message_of<MethodError>(
        [&] { method->select(command_of(of.task, of.commands.front().utterance), of.space, services); });
  };
  EXPECT_SAYS(refusal("sweep_block_without_touching_pan", "flat"), "got one with the object to be avoided, on which");
  EXPECT_SAYS(refusal("stack_small_block_on_hexagon", "flat"), "got one with the object to put it on, on which");
  EXPECT_SAYS(refusal("words_relation_leftmost_drink", "structured"), "a meaning without a rule");
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

// Where it acts tells what it took for the target: the middle of what is in its mask.
TEST_F(Relatives, LikenessInNameAndChoiceWithinASelectionDecideWhatIsTaken) {
  const ActionSpace& actions = find_environment("tabletop").action_space();
  const std::uint8_t shown_id = *taken(demonstrations.front(), actions);
  std::vector<Demonstration> shown(1, demonstrations.front());
  const auto rename = [](Observation& seen, std::uint8_t id, const char* type, const char* texture) {
    for (Instance& one : seen.instances)
      if (one.id == id) one.object_type = type, one.texture = texture;
  };
  rename(shown[0].steps[0].observation, shown_id, "letter A", "red and yellow stripe");
  std::vector<std::uint8_t> ids;  // of the probe, in view
  for (const Instance& one : probe.instances)
    if (one.pixels > 50 && !is_place(one.object_type)) ids.push_back(one.id);
  ASSERT_GE(ids.size(), 2u);
  Observation seen = probe;
  for (const std::uint8_t id : ids) rename(seen, id, "ring", "tiger");
  rename(seen, ids[1], "letter V", "blue and purple stripe");
  const auto middle = [&](std::uint8_t id) {
    const auto all = placed(seen);
    return *std::find_if(all.begin(), all.end(), [id](const Placed& one) { return one.instance.id == id; });
  };
  const auto acts_on = [&](const char* id, const Meaning& selected, const std::string& utterance) {
    const PluginInfo& plugin = catalogue.find("method", id);
    const Json all = resolve_options(plugin, {{"policy", "centroid"}});
    method = load_method(plugin);
    RecordedLanguageModel lm(scenario, scenario.recorded);
    TruthAsHuman human(scenario.commands);
    Services services{lm, human, all, seed, log, actions};
    const Command command{utterance, scenario.task};
    Instruction told{utterance, method->select({instruction.utterance, scenario.task}, scenario.space, services)};
    if (!selected.empty()) told.selection.target = selected;
    if (method->needs(all).revise) told.selection = method->revise(command, told.selection, shown, services);
    const Action action = method->learn(shown, services)->act(seen, told);
    const Vec2 from = in_picture(actions, actions.places[0], action, seen.size);
    std::uint8_t nearest = 0;
    for (const std::uint8_t one : ids)
      if (nearest == 0 || norm(Vec2{middle(one).column, middle(one).row} - from) <
                              norm(Vec2{middle(nearest).column, middle(nearest).row} - from))
        nearest = one;
    return nearest;
  };
  const std::string& own = instruction.utterance;
  EXPECT_EQ(acts_on("taken_names", {}, own), ids[1]) << "another letter with stripes";
  rename(seen, ids[0], "letter V", "blue and purple stripe");
  rename(seen, ids[1], "ring", "tiger");
  EXPECT_EQ(acts_on("taken_names", {}, own), ids[0]);

  // Of the two that the Selection keeps the one whose texture was taken.
  rename(seen, ids[0], "letter V", "tiger");
  rename(seen, ids[1], "ring", "red and yellow stripe");
  const Meaning both({"letter V", "ring"}, {"tiger", "red and yellow stripe"});
  EXPECT_EQ(acts_on("lga_then_taken", both, own), ids[1]);
  rename(seen, ids[0], "letter V", "red and yellow stripe");
  rename(seen, ids[1], "ring", "tiger");
  EXPECT_EQ(acts_on("lga_then_taken", both, own), ids[0]);
  EXPECT_EQ(acts_on("lga_then_taken", Meaning({"ring"}, {"tiger"}), own), ids[1]) << "it keeps one alone";
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

// Two scenes, as if one came after the other.
Demonstration of_two_steps(const Scenario& scenario) {
  const auto environment =
      make_environment(scenario, load_engine(scan_plugins(plugin_directories()).find("engine", "kinematic")));
  Demonstration one{{scenario.commands.front().utterance, {}}, {}};
  for (int i = 0; i < 2; ++i) {
    Observation seen = environment->reset(training_scene(scenario, layouts_of(scenario).front(), {}, 1, i));
    one.steps.push_back({std::move(seen), environment->expert_action()});
  }
  return one;
}

TEST(SeveralSteps, TellRulesOfLabelsWhatEachTookAndWhereItWasBrought) {
  const Scenario scenario = load_scenario("fetch_fruit");
  Demonstration one = of_two_steps(scenario);
  one.steps.push_back({one.steps.front().observation, {}});  // nothing is left to do
  const TakenFeatures features = taken_by({one}, actions_of(scenario));
  EXPECT_EQ(features.taken.objects.size(), 2u);
  EXPECT_EQ(features.received.objects.size(), 2u);
}

TEST(SeveralSteps, AreRefusedByTheRuleOfAPerson) {
  const Scenario scenario = load_scenario("persons_20261127_01");
  const PluginInfo plugin = scan_plugins(plugin_directories()).find("method", "person_rule");
  const std::vector<Demonstration> shown{of_two_steps(scenario)};
  const Command command{shown.front().instruction.utterance, scenario.task};
  for (const char* learns : {"words", "bayes", "common_looks"}) {
    const Json all = resolve_options(plugin, {{"learns", learns}});
    const auto method = load_method(plugin);
    RecordedLanguageModel lm(scenario, scenario.recorded);
    TruthAsHuman human(scenario.commands);
    Silent log;
    Services services{lm, human, all, 0, log, actions_of(scenario)};
    const Selection first = method->select(command, scenario.space, services);
    const auto revise = [&] { method->revise(command, first, shown, services); };
    if (learns == std::string("words"))
      EXPECT_NO_THROW(revise());
    else
      EXPECT_SAYS(
          message_of<MethodError>(revise),
          fmt::format("learns {}: expected demonstrations of one step, got 2: a person's rule says what", learns));
  }
}

}  // namespace
}  // namespace lgabench
