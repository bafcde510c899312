lgabench_unit_test(host_test READ SOURCES ${CMAKE_CURRENT_LIST_DIR}/host_confine_test.cpp ${CMAKE_CURRENT_LIST_DIR}/host_frames_test.cpp ${CMAKE_CURRENT_LIST_DIR}/host_ledger_test.cpp
                   LINK lgabench_host)
