lgabench_unit_test(leaderboard_test SOURCES ${CMAKE_CURRENT_LIST_DIR} / leaderboard_test.cpp ${CMAKE_CURRENT_LIST_DIR} /
                   leaderboard_pages_test.cpp LINK lgabench_leaderboard valijson)
