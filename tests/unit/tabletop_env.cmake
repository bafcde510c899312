lgabench_unit_test(tabletop_env_test SOURCES tabletop_env_test.cpp tabletop_sweep_test.cpp ${PROJECT_SOURCE_DIR}/envs/mujoco/mujoco_world.cpp
                   LINK lgabench_tabletop mujoco::mujoco)
lgabench_unit_test(tabletop_predicates_test SOURCES tabletop_predicates_test.cpp LINK lgabench_tabletop)
