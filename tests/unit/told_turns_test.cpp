// Selections that say how objects are used in turn: their masks, words, corrections, errors and scores.
#include <algorithm>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/meaning_reply.hpp>
#include <lgabench/abstraction/quality.hpp>
#include <lgabench/abstraction/scene_score.hpp>
#include <lgabench/abstraction/selection_errors.hpp>
#include <lgabench/abstraction/selection_text.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

const FeatureSpace told_space{"s", {"apple", "bowl", "pallet", "pear"}, {"blue", "red"}};
const FeatureSet apples{{"apple"}, told_space.textures}, bowls{{"bowl"}, told_space.textures},
    fruit{{"apple", "pear"}, told_space.textures};

Turn all(const FeatureSet& set) { return {{set}, std::nullopt, {}, {}, false}; }
Turn two(const FeatureSet& set, std::vector<Part> same, std::vector<Part> different = {}) {
  return {{set}, 2, std::move(same), std::move(different), false};
}
Turn one_if_nothing(const FeatureSet& set) { return {{set}, 1, {}, {}, true}; }

Selection told(std::vector<Turn> turns) {
  Selection selection;
  selection.target = in_turns(std::move(turns));
  selection.provenance = Provenance::truth;
  return selection;
}

// A red and a blue apple, a red pear, a red bowl and a place, each on one pixel.
Observation table() {
  Observation seen;
  seen.size = {1, 6};
  seen.ids = {1, 2, 3, 4, 5, 0};
  seen.instances = {{1, "apple", "red", 1},
                    {2, "apple", "blue", 1},
                    {3, "pear", "red", 1},
                    {4, "bowl", "red", 1},
                    {5, "pallet", "red", 1}};
  return seen;
}

using Mask = std::vector<std::uint8_t>;

TEST(Told, AMaskShowsWhatIsWantedNextAsItWasNamed) {
  const Selection each = told({{{fruit}, std::nullopt, {}, {Part::object_type}, false}});
  Observation seen = table();
  EXPECT_EQ(goal_mask(seen, each), (Mask{1, 1, 1, 0, 0, 0}));
  seen.brought = {{"apple", "blue"}};
  EXPECT_EQ(goal_mask(seen, each), (Mask{0, 0, 1, 0, 0, 0}));
  seen.brought = {{"bowl", "red"}};  // what was an apple in truth
  EXPECT_EQ(goal_mask(seen, each), (Mask{0, 0, 0, 0, 0, 0}));
  Mask roles;
  Selection onto = told({all(apples), all({{"bowl", "pallet"}, {"red"}})});
  onto.second = SecondSet{{{"pallet"}, {"red"}}, "onto"};
  seen.brought.clear();
  role_mask(seen, onto, roles);
  EXPECT_EQ(roles, (Mask{1, 1, 0, 0, 2, 0}));
  seen.instances.erase(seen.instances.begin(), seen.instances.begin() + 2);
  seen.ids = {0, 0, 3, 4, 5, 0};
  role_mask(seen, onto, roles);
  EXPECT_EQ(roles, (Mask{0, 0, 0, 1, 2, 0}));
}

TEST(Told, AMeaningWithoutTurnsDoesNotLookAtWhatWasBrought) {
  Selection flat = told({all(fruit)});
  flat.target = fruit;
  Observation seen = table();
  seen.brought = {{"apple", "blue"}, {"bowl", "red"}};
  EXPECT_EQ(goal_mask(seen, flat), (Mask{1, 1, 1, 0, 0, 0}));
}

TEST(Told, TurnsInWords) {
  EXPECT_EQ(meaning_text(in_turns({all(apples), all(bowls)}), told_space), "all of apple; any, then all of bowl; any");
  EXPECT_EQ(
      meaning_text(in_turns({two(fruit, {Part::object_type}, {Part::texture}), one_if_nothing(bowls)}), told_space),
      "2 of apple, pear; any, of the same object type, no two of one texture, or if there is nothing 1 of bowl; "
      "any");
  Turn either = two(apples, {});
  either.sets.push_back({{"bowl"}, {"red"}});
  either.different = {Part::object_type, Part::texture};
  EXPECT_EQ(selection_text(told({either}), told_space),
            "target: 2 of apple; any or bowl; red, no two of one object type and texture");
}

TEST(Told, AReplyMayHoldTurns) {
  const std::string turns = R"({"turns": [{"sets": [{"object_types": ["apple"], "textures": "ALL"}], "take": )";
  EXPECT_EQ(meaning_in("First I think.\nFinal answer: " + turns + R"("all"}]})", told_space), in_turns({all(apples)}));
  EXPECT_SAYS(message_of<MethodError>([&] { meaning_in("Final answer: " + turns + "0}]}", told_space); }),
              "/turns/0/take");
}

TEST(Told, APersonCorrectsObjectTypesAndHow) {
  const Selection truth = told({all(fruit), all(bowls)});
  TruthAsHuman human({{"words", truth}});
  Selection proposal = told({all({{"apple"}, {"red"}}), all({{"pear"}, {"blue"}})});
  EXPECT_EQ(human.edit({"words", "pick_and_place"}, proposal).target,
            in_turns({all({fruit.object_types, {"red"}}), all({{"bowl"}, {"blue"}})}));
  proposal.target = apples;
  EXPECT_EQ(human.edit({"words", "pick_and_place"}, proposal).target, truth.target);
}

Scenario scenario_of(const Selection& truth, const Json& json = {{"id", "test"}}) {
  Scenario scenario;
  scenario.id = "test";
  scenario.space = told_space;
  scenario.commands = {{"words", truth}};
  scenario.json = json;
  return scenario;
}

TEST(Told, ErrorsAreTheSameInEveryTurn) {
  const Selection truth = told({all(fruit), two({{"bowl", "pear"}, told_space.textures}, {Part::texture})});
  const Scenario scenario = scenario_of(truth);
  EXPECT_EQ(why_no_selection_errors(scenario), "");
  int changed = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Meaning erring = with_errors(truth, scenario, 0, {.3, .3}, seed, "pallet").target;
    ASSERT_EQ(erring.turns.size(), 2u);
    EXPECT_EQ(erring.turns[1].take, 2);
    const auto holds = [&](std::size_t turn, const char* type) {
      const auto& types = erring.turns[turn].sets[0].object_types;
      return std::find(types.begin(), types.end(), type) != types.end();
    };
    EXPECT_EQ(holds(0, "pear"), holds(1, "pear"));  // of both
    EXPECT_FALSE(holds(0, "pallet"));
    changed += !(erring == truth.target);
    Selection product = truth;
    product.target = fruit;
    const FeatureSet alone = with_errors(product, scenario_of(product), 0, {.3, .3}, seed, "pallet").target.product();
    EXPECT_EQ(alone, erring.turns[0].sets[0]) << "as those of a product";
  }
  EXPECT_GT(changed, 20);
  Selection one_set = truth;
  one_set.target = fruit;
  EXPECT_SAYS(message_of<MethodError>([&] {
                with_errors(one_set, scenario, 0, {.3, 0}, 1, "");
              }),
              "expected as many sets as are meant, 2, got 1");
}

TEST(Told, TheTruthIsCoveredByTheSameTurnsAlone) {
  const Scenario scenario = scenario_of(told({two(fruit, {Part::object_type, Part::texture})}));
  const auto covers = [&](const Meaning& meaning) { return covers_truth({{"text", meaning, 1}}, scenario, 0); };
  EXPECT_TRUE(covers(in_turns({two(fruit, {Part::texture, Part::object_type})})));
  EXPECT_TRUE(
      covers(in_turns({two({{"apple", "pear", "pallet"}, told_space.textures}, {Part::object_type, Part::texture})})));
  EXPECT_FALSE(covers(in_turns({two(apples, {Part::object_type, Part::texture})})));
  EXPECT_FALSE(covers(in_turns({two(fruit, {Part::texture})})));
  EXPECT_FALSE(covers(in_turns({all(fruit)})));
  EXPECT_FALSE(covers(fruit));
  const Scenario then = scenario_of(told({all(apples), all(bowls)}));
  EXPECT_FALSE(covers_truth({{"text", in_turns({all(bowls), all(apples)}), 1}}, then, 0));
}

TEST(Told, AScenesErrandSaysWhatIsMeantAtFirst) {
  Scene scene;
  for (const Instance& one : table().instances)
    scene.objects.push_back({one.object_type, one.texture, role::target, {}, 0, one.id, 1});
  const std::uint64_t without = scene.hash();
  EXPECT_EQ(to_json(scene).count("errand"), 0u);
  scene.errand = in_turns({all(bowls), all(apples)});
  EXPECT_EQ(meant_at_first(scene), (std::vector<bool>{false, false, false, true, false}));
  const std::uint64_t one_errand = scene.hash();
  EXPECT_NE(one_errand, without);
  SceneScore score;
  add_scene(scene, table(), {4}, false, score);
  EXPECT_EQ(score.exact_scenes, 1);
  EXPECT_EQ(score.meant, 1);
  scene.errand = in_turns({all(apples), all(bowls)});
  EXPECT_NE(scene.hash(), one_errand);
  add_scene(scene, table(), {4}, false, score);
  EXPECT_EQ(score.exact_scenes, 1);
}

}  // namespace
}  // namespace lgabench
