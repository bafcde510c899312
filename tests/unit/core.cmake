lgabench_unit_test(core_test READ SOURCES core_test.cpp parallel_test.cpp process_test.cpp system_test.cpp suggest_test.cpp rounding_test.cpp environments_test.cpp meaning_test.cpp turns_test.cpp
                   LINK lgabench_core lgabench_tabletop)
target_compile_definitions(core_test PRIVATE LGABENCH_GOLDEN="${CMAKE_CURRENT_SOURCE_DIR}/golden")
