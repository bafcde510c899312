// Scenes in their thousands: what docs/protocol.md, section 3 promises of every one, and of their frequencies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <common/objects.hpp>
#include <lgabench/core/hash.hpp>
#include <tabletop/content.hpp>
#include <tabletop/near_misses.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/task.hpp>

#include "../conformance/arms.hpp"
#include "testing.hpp"

namespace lgabench::tabletop {
namespace {

constexpr int many = 10000;
// Of every scenario and layout; all with ./test --full.
const int each = amount(100, many);

SceneRequest test_request(const std::string& layout, std::uint64_t seed = 0, const std::string& arm = "test") {
  return {layout, "test", arm, seed};
}

SceneRequest train_request(const std::string& layout, std::uint64_t seed = 0) {
  return {layout, "train", "train", seed};
}

SceneRequest train_request(const Selection& selection, const std::string& layout, std::uint64_t seed = 0) {
  return {layout, "train", "train", seed, {selection}};
}

std::vector<const SceneObject*> of_role(const Scene& scene, const Role& role) {
  std::vector<const SceneObject*> found;
  for (const SceneObject& o : scene.objects)
    if (o.role == role) found.push_back(&o);
  return found;
}

std::vector<Polygon> outline(const SceneObject& o) {
  return placed_outline(object_model(o.object_type), o.position_m, o.yaw_rad);
}

bool is_letter(const std::string& type) { return type.compare(0, 7, "letter ") == 0; }

const Content& content_of(const Scenario& s, const Scene& scene) { return tabletop::content_of(s, scene.arm); }

std::vector<std::string> layouts(const std::string& task) {
  return lgabench::find_task(find_environment("tabletop"), task).layouts;
}

const ScenarioCommand& command_of(const Scenario& s, const Scene& scene) {
  return s.commands[static_cast<std::size_t>(scene.command)];
}

// The command, read with its true distribution: would this object be right beside that target?
bool satisfies(const Scenario& s, const Scene& scene, const SceneObject& object, const SceneObject& target) {
  if (!command_of(s, scene).truth.target.belongs(object.object_type, object.texture)) return false;
  return !content_of(s, scene).later_letters || object.object_type <= target.object_type;
}

// What moves during the task, as far as it stays on the table: the target set down at the goal, the disc that it sweeps
// while it turns, the way of spatula and target to the free zone.
std::vector<Polygon> swept(const Scene& scene, SceneObject target) {
  const ObjectModel& model = object_model(target.object_type);
  if (scene.task == "pick_and_place") {
    target.position_m = scene.find(role::goal)->position_m;
    return outline(target);
  }
  if (scene.task == "rotate") {
    Polygon disc;
    for (int i = 0; i < 64; ++i)
      disc.push_back(target.position_m + rotated({model.radius_m, 0}, 2 * 3.14159265358979323846 * i / 64));
    return {disc};
  }
  if (scene.task != "sweep") return {};
  const double half = std::max(.06, model.radius_m),
               side = scene.find("obstacle")->position_m.y < target.position_m.y ? 1 : -1;
  double back = 0;  // of the target, from its centre
  for (const Polygon& polygon : outline(target))
    for (const Vec2 p : polygon) back = std::max(back, side * (target.position_m.y - p.y));
  const double x = target.position_m.x, y0 = target.position_m.y - side * (back + .04), y1 = side * .48;
  return {{{x - half, std::min(y0, y1)},
           {x + half, std::min(y0, y1)},
           {x + half, std::max(y0, y1)},
           {x - half, std::max(y0, y1)}}};
}

void check_geometry(const Scenario& s, const Scene& scene) {
  const SceneObject* goal = scene.find(role::goal);
  // In fixed places, a few wide pairs are nearer than the margin: two frames, a line and a frame.
  const bool may_be_near = scene.task == "sweep" || (scene.task == "rotate" && scene.layout == "cells");
  const double margin = may_be_near ? .0049 : .0199;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const auto a = outline(scene.objects[i]);
    for (const Polygon& polygon : a)  // a line beside a sweep's target reaches from border to border of its half
      for (const Vec2 p : polygon) ASSERT_TRUE(Workspace::contains(Vec2{.5, 0} + (1 - 1e-9) * (p - Vec2{.5, 0})));
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_GE(distance(a, outline(scene.objects[j])), margin) << canonical(to_json(scene));
    ASSERT_TRUE(!goal || &scene.objects[i] == goal || norm(scene.objects[i].position_m - goal->position_m) > .1);
  }
  const bool barring = !content_of(s, scene).choice.empty() && scene.task == "sweep";  // may be touched
  for (const SceneObject* target : of_role(scene, role::target)) {
    const auto moved = swept(scene, *target);
    for (const SceneObject& o : scene.objects) {
      if (moved.empty() || &o == target || o.role == role::goal || (barring && o.role == role::distractor)) continue;
      ASSERT_GE(distance(moved, outline(o)), margin) << canonical(to_json(scene));
    }
  }
}

void check_roles(const Scenario& s, const Scene& scene) {
  const ScenarioCommand& command = command_of(s, scene);
  const Content& content = content_of(s, scene);
  const auto second = tabletop::find_task(s.task).second();
  const auto targets = of_role(scene, role::target), seconds = of_role(scene, second ? second->in_scenes : "none");
  std::size_t right = 0;  // of a choice
  for (const std::string& type : content.choice)
    right += second ? command.truth.second->contains(type, "red") : command.truth.target.belongs(type, "red");
  ASSERT_EQ(targets.size(), content.choice.empty() || second ? 1u : right);
  ASSERT_EQ(seconds.size(), !second ? 0u : content.choice.empty() ? 1u : right);
  ASSERT_EQ(of_role(scene, role::goal).size(), s.task == "pick_and_place" ? 1u : 0u);
  const SceneObject* goal = scene.find(role::goal);
  for (const SceneObject* target : targets) {
    ASSERT_TRUE(command.truth.target.belongs(target->object_type, target->texture));
    ASSERT_TRUE(!content.target || content.target->contains(target->object_type, target->texture));
  }
  for (const SceneObject* other : seconds) {
    ASSERT_TRUE(command.truth.second->contains(other->object_type, other->texture));
    ASSERT_TRUE(!content.second || content.second->contains(other->object_type, other->texture));
  }
  if (goal) {
    ASSERT_EQ(goal->object_type, "pallet");
    ASSERT_EQ(goal->texture, "wooden");
    ASSERT_EQ(goal->yaw_rad, 0);
  }
  ASSERT_EQ(asked_turn_rad(scene) != 0, s.task == "rotate");
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    ASSERT_EQ(scene.objects[i].instance_id, i + 1);
    ASSERT_TRUE(&scene.objects[i] == goal || scene.objects[i].object_type != "pallet");
  }
  for (const SceneObject* d : of_role(scene, role::distractor)) {
    ASSERT_FALSE(satisfies(s, scene, *d, *targets[0])) << canonical(to_json(scene));
    ASSERT_FALSE(command.truth.second && command.truth.second->contains(d->object_type, d->texture));
    ASSERT_FALSE(scene.split != "train" && content.never_distractor &&
                 content.never_distractor->contains(d->object_type, d->texture));
    for (const ScenarioCommand& other : s.commands)
      if (content.outside_all_commands) {
        ASSERT_FALSE(other.truth.target.belongs(d->object_type, d->texture));
        ASSERT_FALSE(other.truth.second && other.truth.second->contains(d->object_type, d->texture));
      }
    const SceneObject& t = *targets[0];
    ASSERT_TRUE(!content.hard || d->texture == t.texture || d->object_type == t.object_type);
  }
}

class Scenes : public testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  const Scenario scenario = load_scenario(std::get<0>(GetParam()));
  const std::string layout = std::get<1>(GetParam());
};

TEST_P(Scenes, KeepTheProtocol) {
  std::set<std::uint64_t> hashes;
  std::set<std::string> contents;
  for (const std::string& id : arms_of_other_scenes(scenario, layout)) {
    const Arm& arm = scenario.arm(id);
    std::map<std::size_t, int> distractors;
    const std::vector<int> commands = scenario.commands_of(arm.id);
    for (int i = 0; i < each; ++i) {
      const Scene test = sample_scene(scenario, test_request(layout, 0, arm.id), i);
      check_geometry(scenario, test);
      check_roles(scenario, test);
      if (HasFatalFailure()) return;
      ++distractors[of_role(test, role::distractor).size()];
      ASSERT_EQ(test.command, commands[static_cast<std::size_t>(i) % commands.size()]);
      if (i % 10 != 0 || &arm != &scenario.tests.front()) continue;
      const Scene train = sample_scene(scenario, train_request(layout), i);
      check_geometry(scenario, train);
      check_roles(scenario, train);
      if (HasFatalFailure()) return;
      EXPECT_TRUE(command_of(scenario, train).seen);
      EXPECT_EQ(of_role(train, role::distractor).size(),
                static_cast<std::size_t>(tabletop::content_of(*scenario.train).distractors.second));
      const Scene dev = sample_scene(scenario, {layout, "dev", arm.id, 0}, i);
      const Scene other_seed = sample_scene(scenario, test_request(layout, 1, arm.id), i);
      for (const Scene& scene : {test, train, dev, other_seed}) {
        hashes.insert(scene.hash());
        contents.insert(canonical(to_json(scene)["objects"]));
      }
    }
    const auto [fewest, most] = tabletop::content_of(*arm.scenes).distractors;
    if (!tabletop::content_of(*arm.scenes).choice.empty()) continue;
    if (fewest == most) {
      EXPECT_EQ(distractors[static_cast<std::size_t>(most)], each) << arm.id;
      continue;
    }
    // In `released`, a target in the second place leaves one place for distractors.
    const int one = layout == "released" && scenario.task != "sweep" ? 3 * each / 4 : each / 2;
    EXPECT_NEAR(distractors[1], one, 2.5 * std::sqrt(each));
    EXPECT_EQ(distractors[1] + distractors[2], each);
  }
  EXPECT_EQ(hashes.size(), 4u * static_cast<unsigned>(each) / 10);
  // Neither splits nor seeds share random numbers; cells are too few for no two scenes to look alike.
  if (layout == "continuous") {
    EXPECT_EQ(contents.size(), 4u * static_cast<unsigned>(each) / 10);
  }
}

// Suite q2: what is compared scene by scene differs in what the arm is named after.
class PairedScenes : public Scenes {};

TEST_P(PairedScenes, DifferInTheirArmAlone) {
  std::set<std::string> textures, hard;
  for (int i = 0; i < each; ++i) {
    const auto scene = [&](const char* arm) { return sample_scene(scenario, test_request(layout, 0, arm), i); };
    const Scene control = scene("control");
    for (const char* arm : {"texture", "distractor", "hard"}) {
      const Scene other = scene(arm);
      const bool more = std::string(arm) != "texture";
      ASSERT_EQ(other.objects.size(), control.objects.size() + more);
      for (const Role which : {role::target, "obstacle", role::goal}) {
        const SceneObject *a = control.find(which), *b = other.find(which);
        ASSERT_EQ(a == nullptr, b == nullptr);
        if (!a) continue;
        ASSERT_EQ(a->object_type, b->object_type);
        ASSERT_EQ(a->position_m.x, b->position_m.x) << arm << " " << i;
        ASSERT_EQ(a->position_m.y, b->position_m.y);
        ASSERT_EQ(a->yaw_rad, b->yaw_rad);
        if (more || which == role::goal) {
          ASSERT_EQ(a->texture, b->texture);
        }
        if (std::string(arm) == "texture" && which == role::target) textures.insert(b->texture);
      }
      if (std::string(arm) == "hard") hard.insert(other.find(role::distractor)->texture);
    }
  }
  EXPECT_EQ(textures, (std::set<std::string>{"pink", "green", "yellow", "wooden", "tiger"}));
  EXPECT_EQ(hard, (std::set<std::string>{"red", "blue"}));
}

TEST_P(Scenes, SayNothingByIdOrPlace) {
  std::map<std::pair<std::size_t, int>, int> target_ids;  // by the number of objects
  std::map<std::pair<double, double>, int> places;
  std::map<std::size_t, int> scenes;
  for (int i = 0; i < each; ++i) {
    const Scene scene = sample_scene(scenario, test_request(layout, 5, scenario.tests.front().id), i);
    const SceneObject& target = *scene.find(role::target);
    ++scenes[scene.objects.size()];
    ++target_ids[{scene.objects.size(), target.instance_id}];
    ++places[{target.position_m.x, target.position_m.y}];
  }
  for (const auto& [n, count] : scenes) {
    const double expected = static_cast<double>(count) / static_cast<double>(n);
    double chi2 = 0;
    for (std::size_t id = 1; id <= n; ++id) {
      const double off = target_ids[{n, static_cast<int>(id)}] - expected;
      chi2 += off * off / expected;
    }
    EXPECT_LT(chi2, 21.1) << n << " objects";  // at most 3 degrees of freedom, p = .0001
  }
  if (layout == "continuous") {
    EXPECT_EQ(places.size(), static_cast<unsigned>(each));
  } else {
    EXPECT_EQ(places.size(), layout == "released" && scenario.task != "sweep" ? 2u : 4u);
    for (const auto& [place, count] : places)
      EXPECT_NEAR(count, each / static_cast<double>(places.size()), 2 * std::sqrt(each));
  }
}

std::vector<std::tuple<std::string, std::string>> every_scenario_and_layout(const std::string& prefix = "") {
  std::vector<std::tuple<std::string, std::string>> all;
  for (const std::string& id : scenario_ids()) {
    if (id.rfind(prefix, 0) != 0) continue;
    const Scenario scenario = load_scenario(id);
    if (scenario.environment->id() != "tabletop") continue;
    if (tabletop::content_of(*scenario.train).by_meaning) continue;  // meant_scenes_test.cpp
    if (tabletop::content_of(*scenario.train).persons) continue;     // persons_test.cpp
    if (tabletop::content_of(*scenario.train).errands) continue;     // errands_test.cpp
    for (const std::string& layout : layouts(scenario.task)) {
      const bool too_wide = id == "q3_food" && layout == "released";  // its pan; refused, see below
      if (!too_wide) all.emplace_back(id, layout);
    }
  }
  return all;
}

std::string name_of(const testing::TestParamInfo<std::tuple<std::string, std::string>>& instance) {
  return std::get<0>(instance.param) + "_" + std::get<1>(instance.param);
}

INSTANTIATE_TEST_SUITE_P(All, Scenes, testing::ValuesIn(every_scenario_and_layout()), name_of);
INSTANTIATE_TEST_SUITE_P(Q2, PairedScenes, testing::ValuesIn(every_scenario_and_layout("q2_")), name_of);

// The hashes of a scenario's first scenes in every layout, in one: 20 of a test arm, or 50 of training.
std::string scenes_hash(const Scenario& s, const std::string& arm) {
  std::string all;
  for (const std::string& layout : layouts(s.task)) {
    const SceneRequest request = arm == "train" ? train_request(layout) : test_request(layout, 0, arm);
    for (int i = 0; i < (arm == "train" ? 50 : 20); ++i) all += hex(sample_scene(s, request, i).hash());
  }
  return sha256(all).substr(0, 16);
}

// The others' scenes: scene_hashes.txt.
TEST(Sampler, TheReleasedTruthChangesTheScenesOfThreeScenarios) {
  const struct {
    const char *id, *tests, *train;  // as version 0.1.0 sampled them, on the truth that the appendix prints
  } changed[] = {{"consonant_with_a_warm_color", "f0cdd01d70654f5d", "08cda45344ed8b0f"},
                 {"red_heart", "8d39389854552449", "2df3936b266fda54"},
                 {"vowel_with_multiple_colors", "3b6528d6c6fd4700", "9589e7cadaa119f9"}};
  for (const auto& known : changed) {
    SCOPED_TRACE(known.id);
    const Scenario printed = load_scenario(known.id, Truth::printed), released = load_scenario(known.id);
    EXPECT_EQ(scenes_hash(printed, "test"), known.tests);
    EXPECT_NE(scenes_hash(released, "test"), known.tests);
    EXPECT_EQ(scenes_hash(printed, "train"), known.train);
    EXPECT_NE(scenes_hash(released, "train"), known.train);
  }
}

TEST(Sampler, SweepIsBarredOnOneSideAtRandom) {
  const Scenario s = load_scenario("sweep_block_without_touching_pan");
  for (const std::string& layout : layouts("sweep")) {
    const double shift = layout == "continuous" ? .03 : 1e-9;
    std::map<std::tuple<bool, bool, bool>, int> seen;  // target's row, target's side, obstacle's side
    for (int i = 0; i < many; ++i) {
      const Scene scene = sample_scene(s, test_request(layout), i);
      const SceneObject &target = *scene.find(role::target), &obstacle = *scene.find("obstacle");
      const Vec2 at = target.position_m;
      const bool low_row = at.x < .5, left = at.y < 0, barred_left = obstacle.position_m.y < at.y;
      const double row = low_row ? .375 : .625;
      EXPECT_LE(std::abs(at.x - row), shift);
      EXPECT_LE(std::abs(at.y - (left ? -.05 : .05)), shift);
      EXPECT_EQ(obstacle.position_m.x, row);
      EXPECT_NEAR(obstacle.position_m.y, at.y + (barred_left ? -.21 : .21), 1e-12);
      EXPECT_EQ(target.yaw_rad, 0);
      for (const SceneObject* d : of_role(scene, role::distractor)) {
        EXPECT_EQ(d->position_m.x, 1 - row);
        EXPECT_EQ(std::abs(d->position_m.y), .16);
      }
      ++seen[{low_row, left, barred_left}];
    }
    EXPECT_EQ(seen.size(), 8u);
    for (const auto& [place, count] : seen) EXPECT_NEAR(count, many / 8.0, 130);
  }
}

TEST(Sampler, SweepTakesItsObstacleFromTheSelection) {
  const Scenario s = load_scenario("sweep_block_without_touching_pan");
  Selection wrong = s.commands[0].truth;
  wrong.second = SecondSet{{{"frame", "star"}, {"red"}}, "avoid"};
  std::set<std::string> obstacles;
  for (int i = 0; i < 200; ++i) {
    const Scene train = sample_scene(s, train_request(wrong, "cells"), i);
    obstacles.insert(train.find("obstacle")->object_type);
    for (const SceneObject* d : of_role(train, role::distractor))
      EXPECT_FALSE(wrong.second->contains(d->object_type, d->texture));
    EXPECT_EQ(sample_scene(s, test_request("cells"), i).find("obstacle")->object_type, "pan");
  }
  EXPECT_EQ(obstacles, (std::set<std::string>{"frame", "star"}));
  wrong.second.reset();
  EXPECT_THROW(sample_scene(s, train_request(wrong, "cells"), 0), InputError);
  wrong = s.commands[0].truth;
  wrong.target.product().object_types = {"frame"};  // wider than the spatula
  EXPECT_THROW(sample_scene(s, train_request(wrong, "cells"), 0), InputError);
}

// Suite q3: one named object and one that no command means, whatever the method selects.
TEST(Sampler, TrainingDistractorsOfSeveralCommandsAreOutsideThemAll) {
  const std::map<std::string, std::set<std::string>> meant{
      {"q3_fruit", {"apple", "tomato", "banana", "orange", "lemon", "pear"}},
      {"q3_food", {"bowl", "container", "pan", "mug", "plate"}},
      {"q3_utensil", {"block", "small block", "shorter block", "L-shaped block", "fork", "spoon", "knife"}}};
  for (const auto& [id, types] : meant) {
    const Scenario s = load_scenario(id);
    std::set<std::string> distractors;
    for (int i = 0; i < many; ++i) {
      const Scene scene = sample_scene(s, train_request("cells"), i);
      ASSERT_EQ(of_role(scene, role::distractor).size(), 1u);
      distractors.insert(scene.find(role::distractor)->object_type);
      if (i >= 100) continue;
      Selection other;
      other.target = {{"heart"}, {"red"}};
      other.second = SecondSet{{{"mug"}, {"red"}}, "avoid"};
      EXPECT_EQ(sample_scene(s, {"cells", "train", "train", 0, {other, other, other}}, i).hash(), scene.hash());
    }
    for (const std::string& type : types) EXPECT_EQ(distractors.count(type), 0u) << type;
    EXPECT_EQ(distractors.size() + types.size() + 1, s.space.object_types.size()) << "all others but the pallet";
  }
}

TEST(Sampler, UtensilsBarAtTheDistancesThatTheScenarioGives) {
  const Scenario s = load_scenario("q3_utensil");
  const auto distance = [](const Scene& scene, const Role& role) {
    return std::abs(scene.find(role)->position_m.y - scene.find(role::target)->position_m.y);
  };
  for (const std::string& layout : layouts("sweep")) {
    int near = 0;
    for (int i = 0; i < many; ++i) {
      const Scene train = sample_scene(s, train_request(layout), i);
      const bool is_near = distance(train, "obstacle") < .2;
      EXPECT_NEAR(distance(train, "obstacle"), is_near ? .17 : .25, 1e-12);
      EXPECT_EQ(train.find(role::distractor)->position_m.x > .5, train.find("obstacle")->position_m.x < .5);
      EXPECT_EQ(std::abs(train.find(role::distractor)->position_m.y), .16);
      near += is_near;

      const Scene seen = sample_scene(s, test_request(layout, 0, "seen"), i),
                  varied = sample_scene(s, test_request(layout, 0, "seen_varied"), i);
      EXPECT_NEAR(distance(seen, "obstacle"), .21, 1e-12);
      EXPECT_NEAR(distance(varied, "obstacle"), distance(varied, "obstacle") < .2 ? .17 : .25, 1e-12);
      EXPECT_NEAR(distance(varied, role::distractor), distance(varied, "obstacle"), 1e-12) << "opposite";
      ASSERT_EQ(seen.objects.size(), varied.objects.size());
      for (std::size_t k = 0; k < seen.objects.size(); ++k) {  // scene by scene the same but for the distance
        EXPECT_EQ(seen.objects[k].object_type, varied.objects[k].object_type);
        EXPECT_EQ(seen.objects[k].texture, varied.objects[k].texture);
        EXPECT_EQ(seen.objects[k].position_m.x, varied.objects[k].position_m.x);
        EXPECT_EQ(seen.objects[k].position_m.y > 0, varied.objects[k].position_m.y > 0);
      }
    }
    EXPECT_NEAR(near, many / 2.0, 250);
  }
}

TEST(Sampler, ClockwiseTurnsTheOtherWayAndChangesNothingElse) {
  const Scenario left = load_scenario("rotate_block");
  Json json = left.json;
  const double turn = asked_turn_rad(sample_scene(left, test_request("cells"), 0));
  EXPECT_NEAR(turn, 120 * 3.14159265358979323846 / 180, 1e-12);
  json["direction"] = "counter_clockwise";
  EXPECT_EQ(asked_turn_rad(sample_scene(read_scenario(json, "test"), test_request("cells"), 0)), turn);
  json["direction"] = "clockwise";
  const Scenario right = read_scenario(json, "test");
  for (int i = 0; i < 20; ++i) {
    const Scene a = sample_scene(left, test_request("continuous"), i),
                b = sample_scene(right, test_request("continuous"), i);
    EXPECT_GT(asked_turn_rad(a), 0);
    EXPECT_EQ(asked_turn_rad(b), -asked_turn_rad(a));
    EXPECT_EQ(to_json(a)["objects"], to_json(b)["objects"]);
  }
}

// A Selection that differs from the truth of "heart" in types and textures.
Selection hearts_and_stars(const Scenario& s) {
  Selection selection = s.commands[0].truth;
  selection.target = {{"heart", "star"}, {"red", "blue", "tiger"}};
  return selection;
}

TEST(Sampler, TestScenesDoNotDependOnTheSelection) {
  const Scenario s = load_scenario("heart");
  for (const std::string& layout : layouts("pick_and_place"))
    for (int i = 0; i < 100; ++i) {
      SceneRequest request = test_request(layout);
      const std::uint64_t without = sample_scene(s, request, i).hash();
      request.selections = {hearts_and_stars(s)};
      EXPECT_EQ(sample_scene(s, request, i).hash(), without);
    }
}

TEST(Sampler, SelectionsShareTheLayout) {
  const Scenario s = load_scenario("heart");
  int same = 0;
  for (int i = 0; i < 200; ++i) {
    const auto target = [&](const Selection& selection, const char* layout) {
      return sample_scene(s, train_request(selection, layout), i).find(role::target)->position_m;
    };
    const Vec2 a = target(s.commands[0].truth, "cells"), b = target(hearts_and_stars(s), "cells");
    EXPECT_EQ(a.x, b.x);
    EXPECT_EQ(a.y, b.y);
    same += norm(target(s.commands[0].truth, "continuous") - target(hearts_and_stars(s), "continuous")) == 0;
  }
  EXPECT_GT(same, 150);  // but where the other shape does not fit
}

TEST(Sampler, TrainingTargetsAreUniformAndDistractorsOutsideTheSelection) {
  const Scenario s = load_scenario("heart");
  const Selection selection = hearts_and_stars(s);
  std::map<std::pair<std::string, std::string>, int> targets;
  std::map<std::string, int> distractor_types;
  for (int i = 0; i < many; ++i) {
    const Scene scene = sample_scene(s, train_request(selection, "cells"), i);
    const SceneObject &target = *scene.find(role::target), &distractor = *scene.find(role::distractor);
    ++targets[{target.object_type, target.texture}];
    ++distractor_types[distractor.object_type];
    EXPECT_FALSE(selection.target.belongs(distractor.object_type, distractor.texture));
  }
  EXPECT_EQ(targets.size(), 6u);
  for (const auto& [features, count] : targets) EXPECT_NEAR(count, many / 6.0, 150);
  EXPECT_EQ(distractor_types.size(), 28u);  // hearts in other textures too; never a pallet
  EXPECT_EQ(distractor_types.count("pallet"), 0u);
  EXPECT_NEAR(distractor_types["heart"], many * 80 / (28.0 * 83 - 6), 100);
  EXPECT_NEAR(distractor_types["bowl"], many * 83 / (28.0 * 83 - 6), 100);
}

TEST(Sampler, NoDistractorWhereEverythingIsSelected) {
  const Scenario s = load_scenario("heart");
  Selection all = s.commands[0].truth;
  all.target = {s.space.object_types, s.space.textures};
  EXPECT_EQ(sample_scene(s, train_request(all, "continuous"), 0).objects.size(), 2u);
}

TEST(Sampler, LaterLettersStandBesideTheEarliest) {
  const Scenario s = load_scenario("letter");
  int with_later = 0, distractors = 0;
  for (int i = 0; i < many; ++i) {
    const Scene scene = sample_scene(s, test_request("cells"), i);
    const std::string& target = scene.find(role::target)->object_type;
    for (const SceneObject* d : of_role(scene, role::distractor)) {
      EXPECT_TRUE(!is_letter(d->object_type) || d->object_type > target);
      distractors += target != "letter V";
      with_later += is_letter(d->object_type);
    }
  }
  EXPECT_NEAR(with_later, .5 * distractors, 250);
}

TEST(Sampler, ReleasedShowsSmallTypesOnly) {
  const Scenario s = load_scenario("something_from_a_typical_kitchen");
  std::set<std::string> targets;
  for (int i = 0; i < 200; ++i) {
    const Scene scene = sample_scene(s, test_request("released"), i);
    targets.insert(scene.find(role::target)->object_type);
    for (const SceneObject* d : of_role(scene, role::distractor))
      EXPECT_LE(std::max(object_model(d->object_type).size_m.x, object_model(d->object_type).size_m.y), .17 + 1e-9);
  }
  EXPECT_EQ(targets, (std::set<std::string>{"bowl", "container"}));
}

TEST(Sampler, RefusesWhatItCannotSample) {
  const Scenario s = load_scenario("heart");
  EXPECT_THROW(sample_scene(s, test_request("circular"), 0), InputError);
  EXPECT_THROW(sample_scene(s, test_request("cells"), -1), InputError);
  EXPECT_THROW(sample_scene(load_scenario("persons_1_01"), test_request("cells"), 0), InputError);
  EXPECT_THROW(sample_scene(s, {"cells", "testing", "test", 0}, 0), InputError);
  EXPECT_THROW(sample_scene(s, {"cells", "test", "hard", 0}, 0), InputError);
  EXPECT_THROW(sample_scene(s, train_request(Selection{}, "cells"), 0), InputError);  // an empty Selection
  Selection pans = s.commands[0].truth;
  pans.target.product().object_types = {"pan"};
  EXPECT_NO_THROW(sample_scene(s, train_request(pans, "cells"), 0));
  EXPECT_THROW(sample_scene(s, train_request(pans, "released"), 0), InputError);
  EXPECT_THROW(sample_scene(load_scenario("q3_food"), test_request("released", 0, "seen"), 0), InputError);
  Selection pallets = s.commands[0].truth;
  pallets.target.product().object_types = {"pallet"};
  EXPECT_THROW(sample_scene(s, train_request(pallets, "cells"), 0), InputError);
}

// The scenario with one arm, of scenes that show these types.
Scenario with_choice(const std::string& id, const std::vector<std::string>& types) {
  Json json = load_scenario(id).json;
  json["tests"] = Json::array({Json{{"arm", "test"}, {"choice", types}}});
  return read_scenario(json, id);
}

TEST(Sampler, AChoiceIsShownWholeOrNotAtAll) {
  const auto objects = [](const Scenario& s, const char* layout) {
    return sample_scene(s, test_request(layout), 0).objects.size();
  };
  const std::vector<std::string> four{"heart", "star", "cross", "ring"},
      five{"heart", "star", "cross", "ring", "diamond"};
  EXPECT_EQ(objects(with_choice("heart", four), "cells"), 5u);  // and the pallet
  EXPECT_EQ(objects(with_choice("heart", five), "continuous"), 6u);
  EXPECT_SAYS(message_of<InputError>([&] { objects(with_choice("heart", five), "cells"); }),
              "layout cells: expected places for all 5 objects of a choice, got 4");
  // What it is to be stacked on might be the one that is left out.
  EXPECT_SAYS(message_of<InputError>([] {
                const std::vector<std::string> onto{"hexagon", "star", "cross", "ring"};
                sample_scene(with_choice("stack_small_block_on_hexagon", onto), test_request("cells"), 0);
              }),
              "layout cells: expected places for all 5 objects of a choice, got 4");
}

TEST(Sampler, AChoiceHoldsWhatTheDistributionMeans) {
  EXPECT_THROW(sample_scene(with_choice("heart", {"star", "cross"}), test_request("cells"), 0), NothingToShow);
  EXPECT_THROW(
      sample_scene(with_choice("sweep_block_without_touching_pan", {"star", "cross"}), test_request("cells"), 0),
      NothingToShow);
  Json json = load_scenario("heart").json;
  json["train"] = {{"choice", {"heart", "star"}}};
  const Scenario s = read_scenario(json, "heart");
  Selection selection = s.commands[0].truth;
  EXPECT_NO_THROW(sample_scene(s, train_request(selection, "cells"), 0));
  selection.target.product().object_types = {"cross"};  // an empty abstraction (run_cell.cpp), not a cell that fails
  EXPECT_THROW(sample_scene(s, train_request(selection, "cells"), 0), NothingToShow);
}

// Published results name scenes by these: a change here makes every earlier run incomparable.
TEST(Sampler, ScenesNeverChange) {
  const auto hashes = [](const char* scenario, const char* layout) {
    const Scenario s = load_scenario(scenario, Truth::printed);
    std::string all;
    for (const int i : {0, 1, 99}) all += hex(sample_scene(s, test_request(layout), i).hash()) + " ";
    return all + hex(sample_scene(s, train_request(layout, 3), 7).hash());
  };
  EXPECT_EQ(hashes("heart", "cells"), "56f4c7ff2daa91c1 516f0b05056f6c1f 6c00665f04c6a18f 3721670e9dc87a93");
  EXPECT_EQ(hashes("heart", "continuous"), "3ee5305e76877d00 c74c1a0a2400a0b1 05559c8daef80dea 4568ab66080c6ffd");
  EXPECT_EQ(hashes("heart", "released"), "66591e642ea54c5d 7aa1023630cc0b2d ddb62b536f9b88e4 585c8cc4e50345ce");
  EXPECT_EQ(hashes("letter", "cells"), "b51b66e52e5a01ea d4a845b2ce11204e b74fb75092aeec35 faae571821a7dab4");
  EXPECT_EQ(hashes("tiger_colored_object", "continuous"),
            "2d922e4ab94f4d47 679905f4a7535869 b361556e68ff8b0b af4b426df34952e7");
  EXPECT_EQ(hashes("consonant_with_a_warm_color", "continuous"),
            "b4736bff3ec6c1c5 66c7ef626e12206e d2880b2d6cc37e28 e2b3597d34f31dc3");
}

TEST(Sampler, SameArgumentsSameBytes) {
  const Scenario s = load_scenario("tiger_colored_object"), again = load_scenario("tiger_colored_object");
  std::vector<std::string> backwards;
  for (int i = 49; i >= 0; --i)
    backwards.push_back(canonical(to_json(sample_scene(again, test_request("continuous"), i))));
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(canonical(to_json(sample_scene(s, test_request("continuous"), i))),
              backwards[static_cast<std::size_t>(49 - i)]);
}

// The hash is from a run of 0.1.
TEST(TestScenes, OfATrainingSeedAreItsOwnAndSharedOnesStay) {
  const Scenario scenario = load_scenario("heart");
  SceneRequest request = test_request("cells");
  const std::uint64_t shared = sample_scene(scenario, request, 0).hash();
  EXPECT_EQ(hex(shared), "56f4c7ff2daa91c1");
  std::set<std::uint64_t> hashes{shared};
  for (const std::uint64_t seed : {0, 1, 2}) {
    request.training_seed = seed;
    hashes.insert(sample_scene(scenario, request, 0).hash());
    EXPECT_EQ(sample_scene(scenario, request, 0).hash(), sample_scene(scenario, request, 0).hash());
  }
  EXPECT_EQ(hashes.size(), 4u);
  request.split = "dev";
  EXPECT_THROW(sample_scene(scenario, request, 0), InputError) << "test scenes alone";
}

// Who takes the largest, or what is as large as what was shown, finds the target by chance.
TEST(Sampler, NearMissesOfMatchedSizeCoverAsMuchAsTheTarget) {
  for (const char* id : {"something_to_drink_water_out_of", "vowel_with_multiple_colors", "plain_colored_vessel"}) {
    Json json = load_scenario(id).json;
    json["tests"] = Json::array({{{"arm", "test"}, {"distractors", {4, 4}}, {"near_miss", {{"size", "matched"}}}}});
    const Scenario scenario = read_scenario(json, id);
    const int scenes = amount(300, 1000);
    int largest = 0;
    for (int i = 0; i < scenes; ++i) {
      const Scene scene = sample_scene(scenario, test_request("continuous"), i);
      std::vector<double> areas;
      const double of_target = [&] {
        const SceneObject& target = *scene.find(role::target);
        return target.scale * target.scale * common::covered_area_m2(target.object_type);
      }();
      for (const SceneObject& object : scene.objects) {
        if (object.role == role::goal) continue;
        areas.push_back(object.scale * object.scale * common::covered_area_m2(object.object_type));
        const std::vector<double> scales = matched_scales(object.object_type);
        EXPECT_EQ(std::count(scales.begin(), scales.end(), object.scale), 1) << "a model for each scale";
        EXPECT_TRUE(fits_matched(object.object_type, .18)) << object.object_type;
      }
      ASSERT_EQ(areas.size(), 5u);
      const auto [least, most] = std::minmax_element(areas.begin(), areas.end());
      EXPECT_LE(*most / *least, 1.16);
      largest += of_target > *most * .98;
    }
    EXPECT_NEAR(largest / static_cast<double>(scenes), 1. / 3, .12) << id << ": of the largest of three sizes";
  }
}

TEST(Objects, CoverWhatTheirOutlineCovers) {
  EXPECT_NEAR(common::covered_area_m2("ring") / common::covered_area_m2("round"), .6, .35) << "it has a hole";
  for (const std::string& type : common::object_types()) {
    const Vec2 box = object_model(type).size_m;
    EXPECT_GT(common::covered_area_m2(type), .1 * box.x * box.y) << type;
    EXPECT_LE(common::covered_area_m2(type), box.x * box.y) << type;
  }
}

}  // namespace
}  // namespace lgabench::tabletop
