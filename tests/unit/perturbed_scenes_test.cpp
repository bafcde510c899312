// Perturbations of bodies and of words: what each level changes, on every engine, and that nothing else differs.
#include <algorithm>
#include <cmath>
#include <set>

#include <common/changed.hpp>
#include <common/objects.hpp>
#include <common/outline.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/perturbed.hpp>
#include <lgabench/cell/run_cell.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/harness/expand.hpp>
#include <lgabench/harness/suite_scenario.hpp>

#include "../engine_under_test.hpp"
#include "../forwarding_world.hpp"
#include "testing.hpp"

namespace lgabench {
namespace {

constexpr int played_of_each = 8;

// The scenario with an arm for each axis and level that it can have, and its control as `control` says.
Scenario with_arms(const std::string& id, const Json& control, const std::vector<std::string>& axes) {
  Json json = load_scenario(id).json;
  Json first = json["tests"].front();
  first.update(control);
  first["arm"] = "control";
  json["tests"] = Json::array({first});
  for (const std::string& axis : axes)
    for (int level = 1; level <= 4; ++level) {
      json["tests"].push_back(first);
      json["tests"].back().update({{"arm", arm_of({axis, level})}, {"perturbation", {{axis, level}}}});
    }
  return read_scenario(json, id);
}

Scenario in_suite(const std::string& id) { return suite_scenario(load_suite("perturbations"), id, Truth::released); }

std::string layout_of(const Scenario& scenario) {
  const std::vector<std::string> all = layouts_of(scenario);
  return std::find(all.begin(), all.end(), "continuous") == all.end() ? all.front() : "continuous";
}

Scene scene_of(const Scenario& scenario, const std::string& arm, int index) {
  return test_scene(scenario, layout_of(scenario), arm, 0, index);
}

const PluginInfo& engine(const std::string& id) {
  static const Catalogue all = scan_plugins(plugin_directories());
  return all.find("engine", id);
}

// Episodes of all arms, as a cell notes them, where what was selected is the truth.
std::vector<PerturbedEpisode> noted(const Scenario& scenario, std::unique_ptr<PhysicsWorld> world) {
  const auto environment = make_environment(scenario, std::move(world));
  std::vector<PerturbedEpisode> all;
  for (const Arm& arm : scenario.tests) {
    const Perception perception = perception_of(scenario, arm);
    for (int i = 0; i < played_of_each; ++i) {
      const Scene scene = scene_of(scenario, arm.id, i);
      const Scene control = scenario.environment->sample(scenario, {layout_of(scenario), "test", arm.id, 0}, i);
      Observation seen = environment->reset(scene);
      if (const View view = view_of(scenario, scene); view != View()) seen = environment->look(view);
      if (perception) seen = perception(seen, scene, 0);
      const ScenarioCommand& command = scenario.commands[static_cast<std::size_t>(scene.command)];
      const Instruction told{command.utterance, command.truth};
      all.push_back({arm.id, i, arm.perturbation ? arm.perturbation->axis : "",
                     arm.perturbation ? arm.perturbation->level : 0,
                     parts_of({scene, environment->bodies(), control}, seen, &told, &told)});
    }
  }
  return all;
}

TEST(PerturbedScenes, EveryAxisChangesWhatItDeclaresAndNothingElse) {
  for (const char* id : {"heart", "q2_block"}) {
    SCOPED_TRACE(id);
    Scenario scenario = in_suite(id);
    const auto selects = [](const Arm& arm) {  // in a cell: told_in()
      return arm.perturbation && (arm.perturbation->axis == "selection_errors" || arm.perturbation->axis == all_axes);
    };
    scenario.tests.erase(std::remove_if(scenario.tests.begin(), scenario.tests.end(), selects), scenario.tests.end());
    EXPECT_NO_THROW(expect_declared(noted(scenario, make_engine()), {}, false, scenario));
  }
}

TEST(PerturbedScenes, BodiesChangeInEveryEnvironmentAndOnEveryEngine) {
  const std::vector<std::string> bodies{"distractors", "object_size", "friction_mass"};
  for (const auto& [id, control] :
       std::vector<std::pair<std::string, Json>>{{"heart", {{"distractors", {2, 2}}}},
                                                 {"bring_fruit", {{"distractors", {1, 1}}}},
                                                 {"fetch_fruit", {{"distractors", {2, 2}}}}})
    for (const char* of : {"mujoco", "bullet"}) {
      SCOPED_TRACE(id + " on " + of);
      const Scenario scenario = with_arms(id, control, bodies);
      EXPECT_NO_THROW(expect_declared(noted(scenario, load_engine(engine(of))), {}, false, scenario));
    }
}

struct Careless : ForwardingWorld {  // of mass and friction
  Careless() : ForwardingWorld(make_engine()) {}
  void load(const std::vector<BodyModel>& models, int bodies) override {
    std::vector<BodyModel> alike = models;
    for (BodyModel& model : alike) model.mass_kg = .1, model.friction = 1;
    ForwardingWorld::load(alike, bodies);
  }
};

TEST(PerturbedScenes, AnEngineThatIgnoresFrictionAndMassIsCaught) {
  const Scenario scenario = with_arms("heart", {{"distractors", {2, 2}}}, {"friction_mass"});
  EXPECT_SAYS(message_of<EngineError>(
                  [&] { expect_declared(noted(scenario, std::make_unique<Careless>()), {}, false, scenario); }),
              "perturbation friction_mass at level 1: physics equals the control's in 8 of 8 episodes");
}

struct Shifting : ForwardingWorld {  // what is heavy
  Shifting() : ForwardingWorld(make_engine()) {}
  void reset(const std::vector<BodyPlacement>& placements) override {
    ForwardingWorld::reset(placements);
    heavy_ = physics(0)->mass_kg > .3;
  }
  Pose pose(int body) const override {
    Pose at = ForwardingWorld::pose(body);
    if (heavy_) at.position_m.x += 1e-6;
    return at;
  }
  bool heavy_ = false;
};

TEST(PerturbedScenes, AnEngineThatPutsHeavyBodiesElsewhereIsCaught) {
  const Scenario scenario = with_arms("heart", {{"distractors", {2, 2}}}, {"friction_mass"});
  EXPECT_SAYS(message_of<EngineError>(
                  [&] { expect_declared(noted(scenario, std::make_unique<Shifting>()), {}, false, scenario); }),
              "objects differs from the control's");
}

// What the engine has of the target at each level, the control first.
std::vector<EngineBody> target_at_each(const Scenario& scenario, const std::string& axis, const std::string& on,
                                       int index) {
  const auto environment = make_environment(scenario, load_engine(engine(on)));
  std::vector<EngineBody> all;
  for (int level = 0; level <= 4; ++level) {
    const Scene scene = scene_of(scenario, level == 0 ? "control" : arm_of({axis, level}), index);
    environment->reset(scene);
    all.push_back(environment->bodies().at(static_cast<std::size_t>(scene.find(role::target) - scene.objects.data())));
  }
  return all;
}

TEST(PerturbedScenes, EnginesSimulateTheFrictionAndTheMassOfTheLevel) {
  constexpr std::array friction{1., .8, .5, .25, .1}, mass{1., 1.5, 2., 4., 8.};
  const Scenario scenario = with_arms("heart", {{"distractors", {2, 2}}}, {"friction_mass"});
  for (const char* of : {"mujoco", "bullet"}) {
    const auto bodies = target_at_each(scenario, "friction_mass", of, 0);
    for (std::size_t level = 0; level < bodies.size(); ++level) {
      EXPECT_NEAR(bodies[level].physics->friction / bodies[0].physics->friction, friction[level], 1e-9) << of;
      EXPECT_NEAR(bodies[level].physics->mass_kg / bodies[0].physics->mass_kg, mass[level], 1e-9) << of;
    }
  }
}

// How far a flat box slides that is let go in mid-motion, just above the table.
double slides_m(const std::string& on, double friction) {
  const auto world = load_engine(engine(on));
  BodyModel box{"box", {{}}};
  for (const double x : {-.05, .05})
    for (const double y : {-.05, .05})
      for (const double z : {0., .02}) box.pieces[0].corners_m.push_back({x, y, z});
  box.friction = friction;
  world->load({box}, 1);
  world->reset({{0, {{.4, 0, 0}, {}}}});
  world->grip(0, {{.4, 0, .02}, {}});
  constexpr double speed = 1;
  for (int i = 1; i <= 40; ++i) {
    world->move_gripper({{.4, i * speed * world->time_step_s(), .02 + 5e-4}, {}});
    world->step();
  }
  world->release();
  const double from = world->pose(0).position_m.y;
  for (double t = 0; t < 2; t += world->time_step_s()) world->step();
  return world->pose(0).position_m.y - from;
}

TEST(PerturbedScenes, ASlipperyBodySlidesFarther) {
  for (const char* of : {"mujoco", "bullet"}) {
    double before = 0;
    for (const double friction : {1., .8, .5, .25, .1}) {
      const double way = slides_m(of, friction);
      EXPECT_GT(way, 1.1 * before) << of << " " << friction;
      before = way;
    }
    EXPECT_GT(before, 4 * slides_m(of, 1)) << of;
  }
}

TEST(PerturbedScenes, SizesGrowWithTheLevelAndLeaveRoom) {
  int up = 0, held_back = 0;
  const Scenario scenario = in_suite("tiger_colored_object");
  const auto outline = [](const SceneObject& o) {
    return common::placed_outline(common::object_model(o.object_type, o.scale), o.position_m, o.yaw_rad);
  };
  for (int i = 0; i < 20; ++i) {
    const Scene control = scene_of(scenario, "control", i);
    double before = 0, scale = 1;
    for (int level = 1; level <= 4; ++level) {
      const Scene scene = scene_of(scenario, arm_of({"object_size", level}), i);
      ASSERT_EQ(scene.objects.size(), control.objects.size());
      const SceneObject& target = *scene.find(role::target);
      scale = target.scale;
      EXPECT_GE(std::abs(scale - 1), before);
      before = std::abs(scale - 1);
      for (std::size_t k = 0; k < scene.objects.size(); ++k) {
        const SceneObject& o = scene.objects[k];
        EXPECT_EQ(o.position_m.x, control.objects[k].position_m.x);
        EXPECT_EQ(o.scale, o.role == role::goal || (scale > 1 && &o != &target) ? 1 : scale);
        if (scale > 1 && &o != &target) {
          EXPECT_GE(common::distance(outline(o), outline(target)), common::room_left_m);
        }
      }
    }
    if (scale >= 1) ++up, held_back += scale < 1.5;
  }
  EXPECT_GT(up, 4);
  EXPECT_LT(up, 16);
  EXPECT_GT(held_back, 0) << "some have no room for a target half as large again";
}

TEST(PerturbedScenes, AnEngineHasTheSizeOfTheLevel) {
  const Scenario scenario = with_arms("heart", {{"distractors", {2, 2}}}, {"object_size"});
  for (const char* of : {"mujoco", "bullet", "kinematic"}) {
    const auto bodies = target_at_each(scenario, "object_size", of, 0);
    const auto height = [&](std::size_t level) {
      return bodies[level].physics->high_m.z - bodies[level].physics->low_m.z;
    };
    for (std::size_t level = 1; level < bodies.size(); ++level) {
      const double scale =
          scene_of(scenario, arm_of({"object_size", static_cast<int>(level)}), 0).find(role::target)->scale;
      EXPECT_NE(scale, 1);
      EXPECT_NEAR(height(level) / height(0), scale, 1e-5) << of;
    }
  }
}

using Standing = std::tuple<std::string, std::string, double, double, double>;
std::set<Standing> standing(const Scene& scene) {
  std::set<Standing> all;
  for (const SceneObject& o : scene.objects)
    all.insert({o.object_type, o.texture, o.position_m.x, o.position_m.y, o.yaw_rad});
  return all;
}

TEST(PerturbedScenes, DistractorsOfALevelAreAmongThoseOfTheNext) {
  for (const auto& [id, control] :
       std::vector<std::pair<std::string, Json>>{{"something_to_drink_water_out_of", {{"distractors", {2, 2}}}},
                                                 {"tiger_colored_object", {{"distractors", {2, 2}}}},
                                                 {"bring_fruit", {{"distractors", {1, 1}}}},
                                                 {"fetch_fruit", {{"distractors", {2, 2}}}}}) {
    SCOPED_TRACE(id);
    const Scenario scenario = with_arms(id, control, {"distractors"});
    int near = 0;
    constexpr int scenes = 12;
    for (int i = 0; i < scenes; ++i) {
      const Scene first = scene_of(scenario, "control", i);
      std::set<Standing> before = standing(first);
      const SceneObject target = *first.find(role::target);
      bool all_near = true;
      for (int level = 1; level <= 4; ++level) {
        const Scene scene = scene_of(scenario, arm_of({"distractors", level}), i);
        const std::set<Standing> now = standing(scene);
        EXPECT_EQ(scene.objects.size(), first.objects.size() + static_cast<std::size_t>(level));
        EXPECT_TRUE(std::includes(now.begin(), now.end(), before.begin(), before.end()));
        for (std::size_t k = 0; k < scene.objects.size(); ++k) EXPECT_EQ(scene.objects[k].instance_id, k + 1);
        for (const auto& [type, texture, x, y, yaw] : now) {
          if (before.count({type, texture, x, y, yaw}) > 0) continue;
          EXPECT_FALSE(scenario.commands.front().truth.target.belongs(type, texture)) << texture << " " << type;
          all_near = all_near && (type == target.object_type || texture == target.texture);
        }
        before = now;
      }
      near += all_near;
    }
    EXPECT_GT(near, 1) << "half of the episodes have near misses";
    EXPECT_LT(near, scenes - 1) << "and half have not";
  }
}

TEST(PerturbedScenes, ManyScenesHaveRoomForFourMore) {
  for (const char* id : {"heart", "something_to_drink_water_out_of", "tiger_colored_object"}) {
    const Scenario scenario = in_suite(id);
    for (int i = 0; i < 200; ++i) EXPECT_NO_THROW(scene_of(scenario, "distractors_4", i)) << id << " " << i;
  }
}

TEST(PerturbedScenes, OtherWordsComeWithTheirAnswersInTheControlsScenes) {
  const Scenario scenario = in_suite("something_to_drink_water_out_of");
  EXPECT_EQ(scenario.recorded, "claude_paraphrases");
  std::set<std::string> words;
  for (int level = 0; level <= 4; ++level) {
    const std::string arm = level == 0 ? "control" : arm_of({"paraphrase", level});
    Scene scene = scene_of(scenario, arm, 3);
    const ScenarioCommand& command = scenario.commands[static_cast<std::size_t>(scene.command)];
    words.insert(command.utterance);
    EXPECT_EQ(command.wording, level);
    EXPECT_EQ(scenario.is_ambiguous(arm), level == 4) << "meaning changes there";
    scene.arm = "control", scene.command = 0;
    EXPECT_EQ(scene.hash(), scene_of(scenario, "control", 3).hash());
  }
  EXPECT_EQ(words.size(), 5u);
  EXPECT_EQ(scenario.commands_of("train"), std::vector<int>{0});
  EXPECT_EQ(scenario.commands_of("all_2"), scenario.commands_of("paraphrase_2"));
}

// Poses after the oracle's action in four of the control's scenes.
std::vector<Pose> played_by_oracle(const Scenario& scenario, const std::string& on) {
  const auto environment = make_environment(scenario, load_engine(engine(on)));
  std::vector<Pose> all;
  for (int i = 0; i < 4; ++i) {
    environment->reset(scene_of(scenario, "control", i));
    environment->step(environment->expert_action());
    for (const EngineBody& body : environment->bodies()) all.push_back(body.pose);
  }
  return all;
}

TEST(PerturbedScenes, AControlEndsToTheBitAsWithoutOtherBodies) {
  for (const char* id : {"heart", "sweep_block_without_touching_pan", "bring_fruit"}) {
    const Json control{{"distractors", {1, 1}}};
    const Scenario alone = with_arms(id, control, {}), among = with_arms(id, control, {"object_size", "friction_mass"});
    EXPECT_EQ(body_variants(alone).size(), 1u);
    EXPECT_GT(body_variants(among).size(), 10u);
    for (const char* of : {"mujoco", "bullet"}) {
      const auto one = played_by_oracle(alone, of), other = played_by_oracle(among, of);
      ASSERT_EQ(one.size(), other.size());
      for (std::size_t k = 0; k < one.size(); ++k) {
        const auto &p = one[k].position_m, &q = other[k].position_m;
        EXPECT_TRUE(p.x == q.x && p.y == q.y && p.z == q.z) << id << " on " << of << ", body " << k;
      }
    }
  }
}

TEST(PerturbedScenes, WhatAScenarioCannotHaveIsRefusedWithTheReason) {
  const auto refusal = [](const std::string& id, const Json& control, const std::string& axis) {
    return message_of<InputError>([&] { with_arms(id, control, {axis}); });
  };
  EXPECT_SAYS(refusal("q2_block", {{"distractors", {1, 1}}}, "distractors"),
              "/tests/1/perturbation: distractors: expected scenes with room for 1 more, q2_block has room for 0");
  EXPECT_SAYS(refusal("rotate_block", Json::object(), "distractors"), "rotate_block has room for 0");
  EXPECT_SAYS(refusal("many_hearts", {{"distractors", {6, 6}}}, "distractors"), "room for 1 more");
  EXPECT_SAYS(refusal("heart", Json::object(), "paraphrase"),
              "expected a command of heart with \"wording\": 1, got none with one");
  EXPECT_SAYS(refusal("words_union_spoon_or_wooden_fork", Json::object(), "selection_errors"),
              "/tests/1/perturbation: selection_errors: expected commands that mean one product");
  const Scenario sweep = with_arms("q2_block", {{"distractors", {1, 1}}}, {all_axes});
  EXPECT_EQ(more_bodies(sweep), 0) << "left out of all";
  EXPECT_NO_THROW(with_arms("words_union_spoon_or_wooden_fork", Json::object(), {all_axes}));
}

TEST(PerturbedScenes, WhatARunCannotHaveIsRefusedBeforeItsCells) {
  const Catalogue all = scan_plugins(plugin_directories());
  const auto refusal = [&all](const std::string& suite, const Json& changes) {
    const Suite loaded = load_suite(suite);
    Design design = apply(JsonReader(changes, "changes"), loaded.design);
    design.methods = {"lga"};
    return message_of<InputError>([&] { expand(loaded, design, {}, all); });
  };
  EXPECT_SAYS(refusal("perturbations", {{"engines", {"kinematic"}}}),
              "friction_mass on the engine kinematic, whose bodies have neither friction nor mass");
  EXPECT_SAYS(refusal("words", {{"selection_errors", Json::array({{{"missing", .1}}})},
                                {"scenarios", {"words_union_spoon_or_wooden_fork"}}}),
              "/selection_errors: scenario words_union_spoon_or_wooden_fork: expected commands that mean one product");
  EXPECT_SAYS(refusal("perturbations", {{"layouts", {"cells"}}, {"scenarios", {"heart"}}}),
              "expected one of: continuous");
}

}  // namespace
}  // namespace lgabench
