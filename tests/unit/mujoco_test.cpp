// What MuJoCo needs beside the conformance suite.
#include "mujoco/mujoco_world.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <common/objects.hpp>
#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

TEST(MujocoWorld, RefusesABodyWithoutVolume) {
  const BodyModel flat{"flat", {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}}};
  EXPECT_THROW(MujocoWorld().load({flat}, 1), EngineError);
}

TEST(MujocoWorld, RefusesCallsBeforeItIsLoaded) {
  MujocoWorld world;
  double height = 0;
  EXPECT_THROW(world.reset({}), EngineError);
  EXPECT_THROW(world.step(), EngineError);
  EXPECT_THROW(world.contacts(), EngineError);
  EXPECT_THROW(world.cast_down({.5, 0}, height), EngineError);
  EXPECT_THROW(world.place_spatula({.12, .01, .05}, {}), EngineError);
  EXPECT_THROW(world.load({common::object_model("block").body}, 0), EngineError);
  EXPECT_THROW(world.load({}, 1), EngineError);
}

TEST(MujocoWorld, AFaultInsideIsAnErrorNotTheEndOfTheProcess) {
  MujocoWorld world;
  world.load({common::object_model("block").body}, 1);
  world.reset({{0, {{.5, 0, 0}, {}}}});
  EXPECT_THROW(mju_error("a fault inside"), EngineError);
  EXPECT_NO_THROW(world.step());
}

TEST(MujocoWorld, ARayBesideATiltedBodyPassesBy) {
  const common::ObjectModel& block = common::object_model("block");
  MujocoWorld world;
  world.load({block.body}, 1);
  world.reset({{0, {{.5, 0, .1}, {std::sin(pi / 8), 0, 0, std::cos(pi / 8)}}}});  // by 45 degrees about x
  const double edge_m = block.size_m.y / 2 * std::cos(pi / 4);                    // its lower one, the farthest in y
  double height = 0;
  EXPECT_EQ(world.cast_down({.5, edge_m - .001}, height), 0);
  EXPECT_EQ(world.cast_down({.5, edge_m + .001}, height), no_body);
}

}  // namespace
}  // namespace lgabench
