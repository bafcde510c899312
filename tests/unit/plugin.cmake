lgabench_unit_test(plugin_test READ SOURCES plugin_test.cpp plugin_refusal_test.cpp plugin_bytes_test.cpp
                   LINK lgabench_core)
target_compile_definitions(plugin_test PRIVATE LGABENCH_TEST_PLUGINS="${PROJECT_BINARY_DIR}/tests/plugins")
add_dependencies(plugin_test fixture_plugins)
