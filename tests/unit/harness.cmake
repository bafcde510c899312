lgabench_unit_test(harness_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/harness_suite_test.cpp
                                        ${CMAKE_CURRENT_LIST_DIR}/harness_cell_test.cpp
                                        ${CMAKE_CURRENT_LIST_DIR}/dart_test.cpp
                   LINK lgabench_cell)
# They play on the real engine and read the real plugins, found as the programs find them: beside lib/.
add_dependencies(harness_test mujoco gcbc_dart gcbc_seg factorial)
