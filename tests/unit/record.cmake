lgabench_unit_test(record_test READ SOURCES ${CMAKE_CURRENT_LIST_DIR}/record_test.cpp ${CMAKE_CURRENT_LIST_DIR}/record_fields_test.cpp ${CMAKE_CURRENT_LIST_DIR}/record_processor_test.cpp
                   LINK lgabench_record lgabench_host lgabench_job valijson)
target_compile_definitions(record_test PRIVATE LGABENCH_FORMATS="${PROJECT_SOURCE_DIR}/docs/formats")
