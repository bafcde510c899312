lgabench_unit_test(repaint_test OPTIMISED SOURCES repaint_test.cpp LINK lgabench_harness lgabench_tabletop)
add_dependencies(repaint_test engines)
target_compile_definitions(repaint_test PRIVATE LGABENCH_TEST_GOLDEN="${CMAKE_CURRENT_LIST_DIR}/golden")
