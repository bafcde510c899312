lgabench_unit_test(learning_test SOURCES learning_test.cpp learning_reference_test.cpp
                   LINK lgabench_learning ${TORCH_LIBRARIES})
add_dependencies(learning_test lga gcbc_dart gcbc_seg factorial)
