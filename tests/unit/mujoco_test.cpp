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

TEST(MujocoWorld, AFaultInsideIsAnErrorNotTheEndOfTheProcess) {
  MujocoWorld world;
  world.load({common::object_model("block").body}, 1);
  world.reset({{0, {{.5, 0, 0}, {}}}});
  EXPECT_THROW(mju_error("a fault inside"), EngineError);
  EXPECT_NO_THROW(world.step());
}

}  // namespace
}  // namespace lgabench
