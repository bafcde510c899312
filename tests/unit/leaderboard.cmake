lgabench_unit_test(leaderboard_test SOURCES leaderboard_test.cpp leaderboard_pages_test.cpp
                   LINK lgabench_leaderboard valijson)
