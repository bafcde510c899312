lgabench_unit_test(plugin_test READ SOURCES plugin_test.cpp plugin_refusal_test.cpp plugin_bytes_test.cpp
                   LINK lgabench_core)
target_compile_definitions(plugin_test PRIVATE LGABENCH_TEST_PLUGINS="${PROJECT_BINARY_DIR}/tests/plugins")
add_dependencies(plugin_test fixture_plugins)

lgabench_unit_test(plugin_cli_test SOURCES plugin_cli_test.cpp LINK lgabench_core)
target_compile_definitions(plugin_cli_test PRIVATE LGABENCH_TEST_PLUGINS="${PROJECT_BINARY_DIR}/tests/plugins"
                                                   LGABENCH_PROGRAM="$<TARGET_FILE:lgabench>")
add_dependencies(plugin_cli_test fixture_plugins lgabench)
