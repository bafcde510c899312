#include <lgabench/plugin/plugin.hpp>

#include "mujoco/mujoco_world.hpp"

LGABENCH_ENGINE("mujoco", "0.1", "MuJoCo 3.17", lgabench::MujocoWorld)
