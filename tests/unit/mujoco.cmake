# The engine's class is compiled in: what is tested is the world, not the loading of a plugin.
lgabench_unit_test(mujoco_test SOURCES mujoco_test.cpp ${PROJECT_SOURCE_DIR}/envs/mujoco/mujoco_world.cpp
                   LINK lgabench_tabletop mujoco::mujoco)
