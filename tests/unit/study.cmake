lgabench_unit_test(study_test READ SOURCES study_protocol_test.cpp study_session_test.cpp study_pairs_test.cpp study_test.cpp study_results_test.cpp LINK lgabench_study
                       lgabench_harness valijson)
