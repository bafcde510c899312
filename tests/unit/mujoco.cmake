# An engine's class is compiled in where a test looks inside; tests/conformance loads it as a plugin.
if(LGABENCH_MUJOCO)
  lgabench_unit_test(mujoco_test SOURCES mujoco_test.cpp ${PROJECT_SOURCE_DIR}/envs/mujoco/mujoco_world.cpp
                     ${PROJECT_SOURCE_DIR}/envs/mujoco/mujoco_pool.cpp
                     LINK lgabench_tabletop mujoco::mujoco)
endif()
