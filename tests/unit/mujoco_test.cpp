// What MuJoCo needs beside the conformance suite.
#include "mujoco/mujoco_world.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace lgabench
