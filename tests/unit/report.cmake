lgabench_unit_test(report_test SOURCES report_statistics_test.cpp report_bootstrap_test.cpp report_test.cpp report_golden_test.cpp report_phi_words_test.cpp report_arms_test.cpp report_schemas_test.cpp
                   report_claims_test.cpp report_suite_claims_test.cpp report_compare_test.cpp report_html_test.cpp report_readers_test.cpp report_engines_test.cpp report_training_test.cpp report_perturbations_test.cpp report_brief_test.cpp report_steps_test.cpp LINK lgabench_report
                   valijson)
add_dependencies(report_test lgabench-worker lgabench_perturbations)  # asked for pictures; says what axes are
target_compile_definitions(report_test PRIVATE LGABENCH_GOLDEN="${CMAKE_CURRENT_SOURCE_DIR}/golden")
