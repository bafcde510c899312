// The engine keeps the contract of PhysicsWorld on every body that the tabletop places.
#include "mujoco/mujoco_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <lgabench/core/error.hpp>
#include <tabletop/objects.hpp>

namespace lgabench {
namespace {

using tabletop::object_model;
using tabletop::object_types;

BodyModel fixed_pallet() {
  BodyModel pallet = object_model("pallet").body;
  pallet.fixed = true;
  return pallet;
}

/// All types, then the fixed pallet: as the environment loads them.
std::vector<BodyModel> all_models() {
  std::vector<BodyModel> models;
  for (const std::string& type : object_types()) models.push_back(object_model(type).body);
  models.push_back(fixed_pallet());
  return models;
}

int index_of(const std::string& type) {
  const auto& types = object_types();
  return static_cast<int>(std::find(types.begin(), types.end(), type) - types.begin());
}
const int pallet_index = static_cast<int>(object_types().size());

MujocoWorld& world() {
  static MujocoWorld* const shared = [] {
    auto* made = new MujocoWorld;
    made->load(all_models(), 3);
    return made;
  }();
  return *shared;
}

BodyPlacement at(const std::string& type, double x, double y, double yaw = 0) {
  return {index_of(type), {{x, y, 0}, from_yaw(yaw)}};
}

void run(PhysicsWorld& w, double seconds) {
  for (int i = 0; i < static_cast<int>(std::lround(seconds / w.time_step_s())); ++i) w.step();
}

bool same(const Pose& a, const Pose& b) {
  return a.position_m.x == b.position_m.x && a.position_m.y == b.position_m.y && a.position_m.z == b.position_m.z &&
         a.rotation.x == b.rotation.x && a.rotation.y == b.rotation.y && a.rotation.z == b.rotation.z &&
         a.rotation.w == b.rotation.w;
}

bool touching(const PhysicsWorld& w, int a, int b) {
  const auto all = w.contacts();
  return std::any_of(all.begin(), all.end(),
                     [&](Contact c) { return (c.a == a && c.b == b) || (c.a == b && c.b == a); });
}

/// Moves less than .5 mm/s and turns less than .5 degree/s, over a fifth of a second.
bool at_rest(PhysicsWorld& w, int body) {
  const Pose before = w.pose(body);
  run(w, .2);
  const Pose after = w.pose(body);
  const Vec3 way = after.position_m - before.position_m;
  const Quat turn =
      Quat{-before.rotation.x, -before.rotation.y, -before.rotation.z, before.rotation.w} * after.rotation;
  return std::hypot(way.x, way.y, way.z) < 1e-4 && 2 * std::hypot(turn.x, turn.y, turn.z) < .1 * 3.14159 / 180;
}

/// Carries body 0 away and drops it: a motion that touches most of the state.
std::vector<Pose> carry_and_drop(PhysicsWorld& w) {
  const Vec3 from = w.pose(0).position_m;
  w.grip(0, {from, {}});
  std::vector<Pose> seen;
  for (int i = 1; i <= 60; ++i) {
    w.move_gripper({from + (i / 60.0) * Vec3{0.05, 0.3, 0.08}, from_yaw(i / 60.0)});
    w.step();
    seen.push_back(w.pose(0));
  }
  w.release();
  for (int i = 0; i < 60; ++i) {
    w.step();
    seen.push_back(w.pose(0));
    seen.push_back(w.pose(1));
  }
  return seen;
}

class EveryType : public testing::TestWithParam<std::string> {};

TEST_P(EveryType, RestsWhereItIsPut) {
  world().reset({{pallet_index, {{.5, .3, 0}, {}}}, at(GetParam(), .5, -.1, .3)});
  world().grip(1, world().pose(1));  // wakes it
  world().step();
  world().release();
  world().step();
  EXPECT_TRUE(touching(world(), 1, table_body));
  run(world(), 1);
  const Pose p = world().pose(1);
  EXPECT_FALSE(same(p, {{.5, -.1, 0}, from_yaw(.3)})) << "asleep: nothing was tested";
  EXPECT_LT(std::hypot(p.position_m.x - .5, p.position_m.y + .1), 5e-4);
  EXPECT_LT(std::abs(p.position_m.z), 5e-4);
  EXPECT_LT(std::hypot(p.rotation.x, p.rotation.y), 1e-3);
  EXPECT_NEAR(yaw_of(p.rotation), .3, 1e-3);
  EXPECT_TRUE(at_rest(world(), 1));
}

TEST_P(EveryType, IsHeldRigidlyAndDroppedToRest) {
  world().reset({at(GetParam(), .4, -.2)});
  const tabletop::ObjectModel& model = object_model(GetParam());
  const Vec3 from{.4 + model.grasp_m.x, -.2 + model.grasp_m.y, model.height_m};
  world().grip(0, {from, {}});
  for (int i = 1; i <= 100; ++i) {
    world().move_gripper({from + (i / 100.0) * Vec3{.1, .3, .1}, from_yaw(i / 100.0)});
    world().step();
  }
  run(world(), .2);  // what lag there is dies out
  const Vec2 grasp = rotated(model.grasp_m, 1);
  const Pose held = world().pose(0);
  EXPECT_NEAR(held.position_m.x, from.x + .1 - grasp.x, 1e-3);
  EXPECT_NEAR(held.position_m.y, from.y + .3 - grasp.y, 1e-3);
  EXPECT_NEAR(held.position_m.z, .1, 1e-3);
  EXPECT_NEAR(yaw_of(held.rotation), 1, 5e-3);
  EXPECT_FALSE(touching(world(), 0, table_body));

  world().move_gripper({{from.x + .1, from.y + .3, model.height_m + .003}, from_yaw(1)});
  run(world(), .3);
  world().release();
  run(world(), .5);
  EXPECT_TRUE(at_rest(world(), 0));
  EXPECT_NEAR(world().pose(0).position_m.z, 0, 5e-4);
}

INSTANTIATE_TEST_SUITE_P(Types, EveryType, testing::ValuesIn(object_types()),
                         [](const testing::TestParamInfo<std::string>& type) {
                           std::string name = type.param;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

TEST(MujocoWorld, ResetForgetsWhatWasPlayedBefore) {
  const std::vector<BodyPlacement> a{at("bowl", .4, -.2), at("block", .45, .1)};
  MujocoWorld fresh;
  fresh.load(all_models(), 3);
  fresh.reset(a);
  const auto expected = carry_and_drop(fresh);

  world().reset({at("heart", .6, .1), at("ring", .6, -.3), {pallet_index, {{.5, .3, 0}, {}}}});
  carry_and_drop(world());
  world().grip(1, world().pose(1));  // left in mid-motion, with the spatula out
  world().place_spatula({.12, .02, .05}, {{.4, -.2, .02}, {}});
  world().step();
  world().reset(a);
  EXPECT_TRUE(same(world().pose(0), a[0].pose));
  const auto again = carry_and_drop(world());
  ASSERT_EQ(expected.size(), again.size());
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_TRUE(same(expected[i], again[i])) << "pose " << i;
}

TEST(MujocoWorld, OtherBodiesFarAwayChangeNothing) {
  world().reset({at("star", .4, -.2), at("block", .45, .1)});
  const auto alone = carry_and_drop(world());
  world().reset({at("star", .4, -.2), at("block", .45, .1), at("pan", .7, -.45)});
  const auto accompanied = carry_and_drop(world());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_NEAR(alone[i].position_m.x, accompanied[i].position_m.x, 1e-9);
    EXPECT_NEAR(alone[i].position_m.z, accompanied[i].position_m.z, 1e-9);
  }
}

TEST(MujocoWorld, AFixedBodyStaysAndCarriesOthers) {
  world().reset({{pallet_index, {{.5, .3, 0}, {}}}, at("block", .5, 0)});
  const double top = object_model("pallet").height_m, height = object_model("block").height_m;
  world().grip(1, {{.5, 0, height}, {}});
  for (int i = 1; i <= 100; ++i) {
    world().move_gripper({{.5, .3 * i / 100, height + top + .005}, {}});
    world().step();
  }
  world().release();
  run(world(), .5);
  EXPECT_TRUE(at_rest(world(), 1));
  EXPECT_NEAR(world().pose(1).position_m.z, top, 1e-3);
  EXPECT_TRUE(same(world().pose(0), {{.5, .3, 0}, {}}));
  EXPECT_THROW(world().grip(0, {{.5, .3, top}, {}}), EngineError);
}

TEST(MujocoWorld, TheSpatulaPushesASleepingBody) {
  world().reset({at("block", .5, 0), at("heart", .5, -.35)});
  world().place_spatula({.12, .01, .06}, {{.5, -.08, .035}, {}});
  bool touched = false;
  for (int i = 1; i <= 200; ++i) {
    world().move_spatula({{.5, -.08 + .2 * i / 200, .035}, {}});
    world().step();
    touched = touched || touching(world(), 0, spatula_body);
  }
  EXPECT_TRUE(touched);
  EXPECT_NEAR(world().pose(0).position_m.y, .12 + .005 + .035, .01);
  EXPECT_NEAR(world().pose(1).position_m.y, -.35, 5e-4);
  world().remove_spatula();
  run(world(), 1);
  EXPECT_TRUE(at_rest(world(), 0));
  EXPECT_FALSE(touching(world(), 0, spatula_body));
}

TEST(MujocoWorld, RaysHitTheTopmostBody) {
  world().reset({at("ring", .5, 0), at("shorter block", .5, 0, .5), at("line", .4, .3)});
  double height = -1;
  EXPECT_EQ(world().cast_down({.5, 0}, height), 1);
  EXPECT_NEAR(height, object_model("shorter block").height_m, 1e-6);
  const Vec2 rim = object_model("ring").grasp_m;
  EXPECT_EQ(world().cast_down(Vec2{.5, 0} + rim, height), 0);
  EXPECT_NEAR(height, object_model("ring").height_m, 1e-6);
  EXPECT_EQ(world().cast_down({.4, .3}, height), 2);
  EXPECT_NEAR(height, object_model("line").height_m, 1e-6);
  EXPECT_EQ(world().cast_down({.3, -.4}, height), no_body);
  EXPECT_EQ(height, 0);
}

TEST(MujocoWorld, RaysFollowABodyThatMoves) {
  world().reset({at("block", .4, -.2)});
  const double top = object_model("block").height_m;
  world().grip(0, {{.4, -.2, top}, {}});
  for (int i = 1; i <= 40; ++i) {
    world().move_gripper({{.4, -.2, top + .1 * i / 40}, {}});
    world().step();
  }
  double height = 0;
  EXPECT_EQ(world().cast_down({.4, -.2}, height), 0);
  EXPECT_NEAR(height, world().pose(0).position_m.z + top, 1e-6);
}

TEST(MujocoWorld, RefusesWhatItCannotDo) {
  EXPECT_THROW(world().reset({{99, {}}}), EngineError);
  EXPECT_THROW(world().reset({{-1, {}}}), EngineError);
  EXPECT_THROW(world().reset(std::vector<BodyPlacement>(4, at("block", .5, 0))), EngineError);
  world().reset({at("block", .5, 0)});
  EXPECT_THROW(world().pose(1), EngineError);
  EXPECT_THROW(world().move_gripper({}), EngineError);
  EXPECT_THROW(world().load(all_models(), 1), EngineError);
  EXPECT_THROW(MujocoWorld().reset({}), EngineError);
  BodyModel flat{"flat", {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}}};
  EXPECT_THROW(MujocoWorld().load({flat}, 1), EngineError);
}

TEST(MujocoWorld, AnInstabilityIsAnErrorAndTheNextSceneIsSound) {
  world().reset({at("block", .5, 0)});
  world().grip(0, {{.5, 0, .07}, {}});
  EXPECT_THROW(
      {
        for (int i = 0; i < 20; ++i) {
          world().move_gripper({{std::nan(""), 0, .07}, {}});
          world().step();
        }
      },
      EngineError);
  EXPECT_THROW(mju_error("a fault inside"), EngineError);  // MuJoCo itself would end the process
  world().reset({at("block", .5, 0)});
  run(world(), .1);
  EXPECT_TRUE(same(world().pose(0), {{.5, 0, 0}, {}}));
}

}  // namespace
}  // namespace lgabench
