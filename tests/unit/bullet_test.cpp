// What Bullet needs beside the conformance suite: it takes bodies by their centre of mass and principal moments.
#include <gtest/gtest.h>

#include <lgabench/core/error.hpp>

#include "bullet/bullet_world.hpp"

namespace lgabench {
namespace {

ConvexPiece box(Vec3 low, Vec3 high) {
  ConvexPiece piece;
  for (const double x : {low.x, high.x})
    for (const double y : {low.y, high.y})
      for (const double z : {low.z, high.z}) piece.corners_m.push_back({x, y, z});
  return piece;
}

TEST(BulletModel, ABoxHasItsTextbookMoments) {
  const BulletModel model = make_bullet_model({"box", {box({0, 0, 0}, {.3, .2, .1})}, 2, false});
  const btVector3 centre = model.mass_frame.getOrigin();
  EXPECT_NEAR(centre.x(), .15, 1e-5);
  EXPECT_NEAR(centre.y(), .1, 1e-5);
  EXPECT_NEAR(centre.z(), .05, 1e-5);
  const double third = 2.0 / 12;  // of the mass, by the squares of the two sides across each axis
  EXPECT_NEAR(model.inertia.x(), third * (.2 * .2 + .1 * .1), 1e-6);
  EXPECT_NEAR(model.inertia.y(), third * (.3 * .3 + .1 * .1), 1e-6);
  EXPECT_NEAR(model.inertia.z(), third * (.3 * .3 + .2 * .2), 1e-6);
}

TEST(BulletModel, PiecesAddUpAndTurnThePrincipalAxes) {
  // An L of three squares: its centre lies at 5/6 of a side, its axes along its diagonal.
  const BulletModel model = make_bullet_model(
      {"L", {box({0, 0, 0}, {.1, .1, .05}), box({.1, 0, 0}, {.2, .1, .05}), box({0, .1, 0}, {.1, .2, .05})}, 3, false});
  EXPECT_NEAR(model.mass_frame.getOrigin().x(), .5 / 6, 1e-5);
  EXPECT_NEAR(model.mass_frame.getOrigin().y(), .5 / 6, 1e-5);
  const btVector3 axis = model.mass_frame.getBasis().getColumn(0);
  EXPECT_NEAR(std::abs(axis.x()), std::sqrt(.5), 1e-4);
  EXPECT_NEAR(std::abs(axis.y()), std::sqrt(.5), 1e-4);
  ASSERT_EQ(model.pieces.size(), 3u);
  EXPECT_NE(model.compound, nullptr);
  btVector3 low, high;  // of the shape in the body's frame: where it was given
  model.compound->getAabb(btTransform::getIdentity(), low, high);
  EXPECT_NEAR(high.z() - low.z(), .05, 1e-4);
}

TEST(BulletModel, AVerticalLineLeavesATurnedPieceWhereItsTopIs) {
  const BulletModel model = make_bullet_model({"box", {box({-.1, -.1, 0}, {.1, .1, .05})}, 1, false});
  const Pose pose{{1, 0, .2}, from_yaw(pi / 4)};
  const auto top = [&](Vec2 p) { return top_at(*model.pieces[0], to_bullet(pose) * model.mass_frame, p); };
  EXPECT_NEAR(top({1.13, 0}), .25, 1e-5);  // inside the turned square only
  EXPECT_LT(top({1.1, .1}), 0);
}

TEST(BulletModel, RefusesABodyWithoutVolume) {
  EXPECT_THROW(make_bullet_model({"flat", {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}}, 1, false}), EngineError);
  EXPECT_THROW(make_bullet_model({"nothing", {}, 1, false}), EngineError);
}

TEST(BulletWorld, WhatIsHeldUpByATableIsNotPressedThroughIt) {
  BulletWorld world;
  world.load({{"box", {box({-.03, -.03, 0}, {.03, .03, .06})}, .1, false}}, 1);
  world.reset({{0, {{.5, 0, 0}, {}}}});
  world.grip(0, {{.5, 0, .06}, {}});
  for (int i = 0; i < 100; ++i) {
    world.move_gripper({{.5, 0, .06 - .002 * i}, {}});
    world.step();
  }
  EXPECT_GT(world.pose(0).position_m.z, -.003);
}

}  // namespace
}  // namespace lgabench
