lgabench_unit_test(abstraction_test READ SOURCES abstraction_test.cpp preference_test.cpp selection_errors_test.cpp textualization_test.cpp told_turns_test.cpp LINK lgabench_core)
find_package(PkgConfig REQUIRED)
pkg_check_modules(HTTPLIB REQUIRED IMPORTED_TARGET cpp-httplib)  # with the macros that the library was built with
find_package(OpenSSL REQUIRED COMPONENTS SSL Crypto)  # a server over TLS, and its certificate
lgabench_unit_test(chat_model_test READ SOURCES chat_model_test.cpp final_answer_test.cpp provider_test.cpp
                   LINK lgabench_core lgabench_openai PkgConfig::HTTPLIB OpenSSL::SSL OpenSSL::Crypto)
lgabench_unit_test(participant_test SOURCES participant_test.cpp LINK lgabench_harness valijson)
