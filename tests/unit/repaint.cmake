lgabench_unit_test(repaint_test SOURCES repaint_test.cpp LINK lgabench_harness lgabench_tabletop)
target_compile_options(repaint_test PRIVATE -O1)
add_dependencies(repaint_test engines)
target_compile_definitions(repaint_test PRIVATE LGABENCH_TEST_GOLDEN="${CMAKE_CURRENT_LIST_DIR}/golden")
