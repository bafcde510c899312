lgabench_unit_test(learning_test SOURCES learning_test.cpp centroid_policy_test.cpp learning_reference_test.cpp noisy_copies_test.cpp
                   LINK lgabench_learning ${TORCH_LIBRARIES})
lgabench_unit_test(learning_allocations_test SOURCES learning_allocations_test.cpp LINK lgabench_learning)
add_dependencies(learning_test lga lga_hill human lga_s lga_l gcbc_dart gcbc_seg factorial)
lgabench_unit_test(sentence_encoder_test SOURCES sentence_encoder_test.cpp LINK lgabench_learning lgabench_encoder)
foreach(reference_test learning_test sentence_encoder_test)
  target_compile_definitions(${reference_test} PRIVATE LGABENCH_TEST_REFERENCE="${PROJECT_SOURCE_DIR}/tests/reference")
endforeach()
