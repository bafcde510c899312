lgabench_unit_test(harness_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/harness_suite_test.cpp
                                        ${CMAKE_CURRENT_LIST_DIR}/harness_cell_test.cpp
                                        ${CMAKE_CURRENT_LIST_DIR}/dart_test.cpp
                                        ${CMAKE_CURRENT_LIST_DIR}/forecast_test.cpp
                                        ${CMAKE_CURRENT_LIST_DIR}/job_test.cpp
                                        ${CMAKE_CURRENT_LIST_DIR}/perturbations_test.cpp
                                        ${CMAKE_CURRENT_LIST_DIR}/views_test.cpp
                                        ${CMAKE_CURRENT_LIST_DIR}/engine_contract_test.cpp
                                        ${CMAKE_CURRENT_LIST_DIR}/taken_test.cpp
                   LINK lgabench_cell lgabench_harness lgabench_tabletop)
target_compile_definitions(harness_test PRIVATE LGABENCH_TEST_REFERENCE="${PROJECT_SOURCE_DIR}/tests/reference")
# They play on a real engine and read the real plugins, found as the programs find them: beside lib/.
add_dependencies(harness_test engines lgabench_perturbations masked_rgb masked_bc texture_aug class_aug erase object_dropout keypoints set_network embedding_select taken_features taken_names lga_taken lga_then_taken lga lga_hill human lga_s lga_l gcbc_dart gcbc_seg factorial plga plga_active)

lgabench_unit_test(perturbed_scenes_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/perturbed_scenes_test.cpp
                   LINK lgabench_cell lgabench_harness lgabench_tabletop)
add_dependencies(perturbed_scenes_test engines lgabench_perturbations lga)
