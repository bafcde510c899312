lgabench_unit_test(record_test READ SOURCES ${CMAKE_CURRENT_LIST_DIR}/record_test.cpp LINK lgabench_record)
