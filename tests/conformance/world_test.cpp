// An engine keeps the contract of PhysicsWorld on every body that the tabletop places.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <common/objects.hpp>
#include <lgabench/cell/engine_contract.hpp>
#include <lgabench/core/error.hpp>
#include <tabletop/tabletop.hpp>

#include "../engine_under_test.hpp"

namespace lgabench {
namespace {

using common::object_model;
using common::object_types;
using tabletop::most_bodies;

/// All types, then the fixed pallet: as the environment loads them.
std::vector<BodyModel> all_models() {
  std::vector<BodyModel> models;
  for (const std::string& type : object_types()) models.push_back(object_model(type).body);
  models.push_back(object_model("pallet").body);
  models.back().fixed = true;
  return models;
}
BodyPlacement pallet(double x, double y) { return {static_cast<int>(object_types().size()), {{x, y, 0}, {}}}; }

std::unique_ptr<PhysicsWorld> fresh_world() {
  auto made = make_engine();
  made->load(all_models(), most_bodies);
  return made;
}

/// One for all tests: what one leaves behind must not matter to the next.
PhysicsWorld& world() {
  static PhysicsWorld* const shared = fresh_world().release();
  return *shared;
}

BodyPlacement at(const std::string& type, double x, double y, double yaw = 0, double z = 0) {
  const auto& types = object_types();
  return {static_cast<int>(std::find(types.begin(), types.end(), type) - types.begin()), {{x, y, z}, from_yaw(yaw)}};
}

int steps_of(const PhysicsWorld& w, double seconds) { return static_cast<int>(std::lround(seconds / w.time_step_s())); }
void run(PhysicsWorld& w, double seconds) {
  for (int i = steps_of(w, seconds); i > 0; --i) w.step();
}

bool same(const Pose& a, const Pose& b) {
  return a.position_m.x == b.position_m.x && a.position_m.y == b.position_m.y && a.position_m.z == b.position_m.z &&
         a.rotation.x == b.rotation.x && a.rotation.y == b.rotation.y && a.rotation.z == b.rotation.z &&
         a.rotation.w == b.rotation.w;
}

double distance(const Pose& a, const Pose& b) {
  const Vec3 way = a.position_m - b.position_m;
  return std::hypot(way.x, way.y, way.z);
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
  const Quat back{-before.rotation.x, -before.rotation.y, -before.rotation.z, before.rotation.w};
  const Quat turn = back * after.rotation;
  return distance(before, after) < 1e-4 && 2 * std::hypot(turn.x, turn.y, turn.z) < .1 * pi / 180;
}

/// The gripper goes straight, in so many seconds.
void carry(PhysicsWorld& w, Vec3 from, Vec3 to, double seconds, double turn = 0) {
  const int n = steps_of(w, seconds);
  for (int i = 1; i <= n; ++i) {
    const double share = static_cast<double>(i) / n;
    w.move_gripper({from + share * (to - from), from_yaw(share * turn)});
    w.step();
  }
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
  const BodyPlacement placed = at(GetParam(), .5, -.1, .3);
  world().reset({pallet(.5, .3), placed});
  EXPECT_TRUE(same(world().pose(1), placed.pose));
  run(world(), .1);
  EXPECT_LT(distance(world().pose(1), placed.pose), 5e-4) << "nobody touched it";
  world().grip(1, world().pose(1));  // wakes what is asleep
  world().step();
  world().release();
  world().step();
  EXPECT_TRUE(touching(world(), 1, table_body));
  run(world(), 1);
  const Pose p = world().pose(1);
  EXPECT_LT(distance(p, placed.pose), 5e-4);
  EXPECT_LT(std::hypot(p.rotation.x, p.rotation.y), 1e-3);
  EXPECT_NEAR(yaw_of(p.rotation), .3, 1e-3);
  EXPECT_TRUE(at_rest(world(), 1));
}

TEST_P(EveryType, IsHeldRigidlyAndDroppedToRest) {
  world().reset({at(GetParam(), .4, -.2)});
  const common::ObjectModel& model = object_model(GetParam());
  const Vec3 from{.4 + model.grasp_m.x, -.2 + model.grasp_m.y, model.height_m}, to = from + Vec3{.1, .3, .1};
  world().grip(0, {from, {}});
  carry(world(), from, to, .5, 1);
  run(world(), .2);  // what lag there is dies out
  const Vec2 grasp = rotated(model.grasp_m, 1);
  const Pose held = world().pose(0);
  EXPECT_LT(distance(held, {{to.x - grasp.x, to.y - grasp.y, .1}, {}}), 2e-3);
  EXPECT_NEAR(yaw_of(held.rotation), 1, 5e-3);
  EXPECT_FALSE(touching(world(), 0, table_body));

  world().move_gripper({{to.x, to.y, model.height_m + .003}, from_yaw(1)});
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

// What check-plugin demands, on bodies of its own.
TEST(World, KeepsTheContractOfCheckPlugin) {
  const auto boxes = make_engine();
  boxes->load(contract_bodies(), contract_bodies_at_once);
  for (const ContractCheck& check : engine_contract()) EXPECT_EQ(check.fault(*boxes), "") << check.name;
}

TEST(World, ResetForgetsWhatWasPlayedBefore) {
  const std::vector<BodyPlacement> a{at("bowl", .4, -.2), at("block", .45, .1)};
  const auto fresh = fresh_world();
  fresh->reset(a);
  const auto expected = carry_and_drop(*fresh);

  world().reset({at("heart", .6, .1), at("ring", .6, -.3), pallet(.5, .3)});
  carry_and_drop(world());
  world().grip(1, world().pose(1));  // left in mid-motion, with the spatula out
  world().place_spatula({.12, .02, .05}, {{.4, -.2, .02}, {}});
  world().step();
  world().reset(a);
  for (int i : {0, 1}) EXPECT_TRUE(same(world().pose(i), a[static_cast<std::size_t>(i)].pose));
  const auto again = carry_and_drop(world());
  ASSERT_EQ(expected.size(), again.size());
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_TRUE(same(expected[i], again[i])) << "pose " << i;
}

TEST(World, OtherBodiesFarAwayChangeNothing) {
  world().reset({at("star", .4, -.2), at("block", .45, .1)});
  const auto alone = carry_and_drop(world());
  world().reset({at("star", .4, -.2), at("block", .45, .1), at("pan", .7, -.45)});
  const auto accompanied = carry_and_drop(world());
  for (std::size_t i = 0; i < alone.size(); ++i) ASSERT_LT(distance(alone[i], accompanied[i]), 1e-4);
}

TEST(World, WhatElseCouldBePlacedChangesNothing) {
  std::vector<BodyModel> models = all_models();
  std::reverse(models.begin(), models.end());
  const auto other = make_engine();
  other->load(models, most_bodies + 3);
  const int last = static_cast<int>(models.size()) - 1;
  for (const std::string& type : object_types()) {
    std::vector<BodyPlacement> placed{at(type, .5, .1), pallet(.55, .38)};
    world().reset(placed);
    const std::vector<Pose> seen = carry_and_drop(world());
    for (BodyPlacement& p : placed) p.model = last - p.model;
    other->reset(placed);
    const std::vector<Pose> again = carry_and_drop(*other);
    EXPECT_TRUE(std::equal(seen.begin(), seen.end(), again.begin(), same)) << type;
  }
}

TEST(World, SuctionLiftsOnlyWhatItHolds) {
  const double height = object_model("block").height_m;
  world().reset({at("block", .5, 0), at("block", .5, .071), at("block", .5, -.071)});  // 1 mm apart
  const Pose left = world().pose(1), right = world().pose(2);
  world().grip(0, {{.5, 0, height}, {}});
  carry(world(), {.5, 0, height}, {.5, 0, height + .1}, .2);
  run(world(), .2);
  EXPECT_NEAR(world().pose(0).position_m.z, .1, 2e-3);
  EXPECT_LT(distance(world().pose(1), left), 2e-4);
  EXPECT_LT(distance(world().pose(2), right), 2e-4);
}

TEST(World, ContactIsMadeWhereASurfaceIsMet) {
  const double top = object_model("pallet").height_m, height = object_model("heart").height_m;
  const auto met_at = [&](double y, double lowest) {  // z of the heart, let down at y until it touches something
    world().reset({at("heart", .5, 0), pallet(.5, .3)});
    const Vec3 up{.5, 0, height + .1}, over{.5, y, height + .1};
    world().grip(0, {{.5, 0, height}, {}});
    carry(world(), {.5, 0, height}, up, .2);
    carry(world(), up, over, .4);
    EXPECT_FALSE(touching(world(), 0, 1));
    for (double z = .1; z > lowest - .02; z -= .001) {
      world().move_gripper({{.5, y, height + z}, {}});
      world().step();
      if (touching(world(), 0, table_body) || touching(world(), 0, 1)) return world().pose(0).position_m.z;
    }
    return -1.;
  };
  EXPECT_NEAR(met_at(0, 0), 0, .0015);
  EXPECT_NEAR(met_at(.3, top), top, .0015);
  EXPECT_TRUE(touching(world(), 0, 1));
  EXPECT_FALSE(touching(world(), 0, table_body));
}

TEST(World, AFixedBodyStaysAndCarriesOthers) {
  world().reset({pallet(.5, .3), at("block", .5, 0)});
  const double top = object_model("pallet").height_m, height = object_model("block").height_m;
  world().grip(1, {{.5, 0, height}, {}});
  carry(world(), {.5, 0, height}, {.5, 0, height + top + .005}, .2);
  carry(world(), {.5, 0, height + top + .005}, {.5, .3, height + top + .005}, .5);
  world().release();
  run(world(), .5);
  EXPECT_TRUE(at_rest(world(), 1));
  EXPECT_NEAR(world().pose(1).position_m.z, top, 1e-3);
  EXPECT_TRUE(same(world().pose(0), pallet(.5, .3).pose));
  EXPECT_THROW(world().grip(0, {{.5, .3, top}, {}}), EngineError);
}

TEST(World, TheSpatulaPushesABodyByAsMuchAsItGoes) {
  for (const double speed : {.1, .25}) {
    world().reset({at("block", .5, 0), at("heart", .5, -.35)});
    world().place_spatula({.12, .01, .06}, {{.5, -.08, .035}, {}});
    bool touched = false;
    const int n = steps_of(world(), .2 / speed);
    for (int i = 1; i <= n; ++i) {
      world().move_spatula({{.5, -.08 + .2 * i / n, .035}, {}});
      world().step();
      const double face = -.08 + .2 * i / n + .005;
      EXPECT_FALSE(touching(world(), 0, spatula_body) && face < -.035 - .002) << "touched from afar";
      touched = touched || touching(world(), 0, spatula_body);
    }
    EXPECT_TRUE(touched);
    EXPECT_NEAR(world().pose(0).position_m.y, .12 + .005 + .035, .01);
    EXPECT_NEAR(world().pose(0).position_m.x, .5, .002);
    EXPECT_NEAR(world().pose(0).position_m.z, 0, .002);
    EXPECT_NEAR(yaw_of(world().pose(0).rotation), 0, .05);
    EXPECT_NEAR(world().pose(1).position_m.y, -.35, 5e-4);
    world().remove_spatula();
    run(world(), 1);
    EXPECT_TRUE(at_rest(world(), 0));
    EXPECT_FALSE(touching(world(), 0, spatula_body));
    EXPECT_LT(world().pose(0).position_m.y, .16 + .02) << "it slides on, and friction stops it";
  }
}

TEST(World, ThePushedPushesOthers) {
  world().reset({at("block", .5, 0), at("block", .5, .1)});
  world().place_spatula({.12, .01, .06}, {{.5, -.08, .035}, {}});
  const int n = steps_of(world(), .8);
  for (int i = 1; i <= n; ++i) {
    world().move_spatula({{.5, -.08 + .2 * i / n, .035}, {}});
    world().step();
  }
  EXPECT_NEAR(world().pose(0).position_m.y, .16, .01);
  EXPECT_NEAR(world().pose(1).position_m.y, .23, .01);
}

TEST(World, RaysHitTheTopmostBody) {
  world().reset({at("ring", .5, 0), at("shorter block", .5, 0, .5), at("line", .4, .3)});
  double height = -1;
  EXPECT_EQ(world().cast_down({.5, 0}, height), 1);
  EXPECT_NEAR(height, object_model("shorter block").height_m, 1e-5);
  const Vec2 rim = object_model("ring").grasp_m;
  EXPECT_EQ(world().cast_down(Vec2{.5, 0} + rim, height), 0);
  EXPECT_NEAR(height, object_model("ring").height_m, 1e-5);
  EXPECT_EQ(world().cast_down({.4, .3}, height), 2);
  EXPECT_NEAR(height, object_model("line").height_m, 1e-5);
  EXPECT_EQ(world().cast_down({.3, -.4}, height), no_body);
  EXPECT_EQ(height, 0);
}

TEST(World, RaysHitTheUpperOfTwoWhicheverWasPlacedFirst) {
  const double top = object_model("pallet").height_m;
  const BodyPlacement block = at("block", .5, .3, 0, top);
  for (const bool first : {true, false}) {
    world().reset(first ? std::vector{block, pallet(.5, .3)} : std::vector{pallet(.5, .3), block});
    double height = 0;
    EXPECT_EQ(world().cast_down({.5, .3}, height), first ? 0 : 1);
    EXPECT_NEAR(height, top + object_model("block").height_m, 1e-5);
    EXPECT_EQ(world().cast_down({.5, .38}, height), first ? 1 : 0) << "beside the block, on the pallet";
    EXPECT_NEAR(height, top, 1e-5);
  }
}

TEST(World, RaysFollowABodyThatMovesAndDoNotSeeTheSpatula) {
  world().reset({at("block", .4, -.2)});
  const double top = object_model("block").height_m;
  world().grip(0, {{.4, -.2, top}, {}});
  carry(world(), {.4, -.2, top}, {.4, -.2, top + .1}, .2);
  double height = 0;
  EXPECT_EQ(world().cast_down({.4, -.2}, height), 0);
  EXPECT_NEAR(height, world().pose(0).position_m.z + top, 1e-5);
  world().place_spatula({.12, .01, .05}, {{.6, .2, .03}, {}});
  EXPECT_EQ(world().cast_down({.6, .2}, height), no_body);
}

TEST(World, RefusesWhatItCannotDo) {
  EXPECT_THROW(world().reset({{99, {}}}), EngineError);
  EXPECT_THROW(world().reset({{-1, {}}}), EngineError);
  EXPECT_THROW(world().reset(std::vector<BodyPlacement>(most_bodies + 1, at("block", .5, 0))), EngineError);
  world().reset({at("block", .5, 0)});
  EXPECT_THROW(world().pose(1), EngineError);
  EXPECT_THROW(world().pose(-1), EngineError);
  EXPECT_THROW(world().move_gripper({}), EngineError);
  EXPECT_THROW(world().move_spatula({}), EngineError);
  EXPECT_THROW(world().load(all_models(), 1), EngineError);
  EXPECT_THROW(make_engine()->reset({}), EngineError);
}

TEST(World, ANumberThatIsNotOneIsAnErrorAndTheNextSceneIsSound) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    world().reset({at("block", .5, 0)});
    world().grip(0, {{.5, 0, .07}, {}});
    EXPECT_THROW(
        {
          for (int i = 0; i < 20; ++i) {
            world().move_gripper({{bad, 0, .07}, {}});
            world().step();
          }
        },
        EngineError);
    world().reset({at("block", .5, 0)});
    run(world(), .1);
    EXPECT_LT(distance(world().pose(0), {{.5, 0, 0}, {}}), 5e-4);
  }
}

}  // namespace
}  // namespace lgabench
