lgabench_unit_test(steps_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/steps_test.cpp
                   LINK lgabench_cell lgabench_host lgabench_learning)
target_compile_definitions(steps_test PRIVATE
  LGABENCH_TEST_ENVIRONMENTS="${PROJECT_BINARY_DIR}/examples/reach2d"
  LGABENCH_TEST_SCENARIOS="${PROJECT_SOURCE_DIR}/examples/reach2d")
add_dependencies(steps_test lgabench_reach2d engines)
