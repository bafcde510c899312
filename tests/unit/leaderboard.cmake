lgabench_unit_test(leaderboard_test READ SOURCES leaderboard_test.cpp leaderboard_pages_test.cpp leaderboard_published_test.cpp
                   leaderboard_undisputed_test.cpp
                   LINK lgabench_leaderboard valijson)
target_compile_definitions(leaderboard_test PRIVATE LGABENCH_BOARD="${PROJECT_SOURCE_DIR}/results/leaderboard")
add_dependencies(leaderboard_test lgabench_perturbations lga lga_hill human lga_s lga_l gcbc_dart gcbc_seg factorial)
