lgabench_unit_test(steps_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/steps_test.cpp
                   LINK lgabench_cell lgabench_host lgabench_learning)
target_compile_definitions(steps_test PRIVATE
  LGABENCH_TEST_PLUGINS="${PROJECT_BINARY_DIR}/tests/plugins/examples"
  LGABENCH_TEST_SCENARIOS="${PROJECT_SOURCE_DIR}/examples/reach2d")
lgabench_add_plugin(reach2d ${PROJECT_SOURCE_DIR}/examples/reach2d/reach2d.cpp
                    DIRECTORY ${PROJECT_BINARY_DIR}/tests/plugins/examples)
lgabench_add_plugin(broken_reach2d ${PROJECT_SOURCE_DIR}/tests/bad_plugins/environments/broken_reach2d.cpp
                    DIRECTORY ${PROJECT_BINARY_DIR}/tests/plugins/broken)
set_target_properties(broken_reach2d PROPERTIES OUTPUT_NAME reach2d)
add_dependencies(steps_test reach2d broken_reach2d engines)
