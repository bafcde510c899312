lgabench_unit_test(plugin_test READ SOURCES plugin_test.cpp plugin_refusal_test.cpp plugin_bytes_test.cpp
                   LINK lgabench_core)
target_compile_definitions(plugin_test PRIVATE LGABENCH_TEST_PLUGINS="${PROJECT_BINARY_DIR}/tests/plugins")
# The example that writes a shipped axis again.
lgabench_add_plugin(tinted_light ${PROJECT_SOURCE_DIR}/examples/tinted_light/tinted_light.cpp
                    DIRECTORY ${PROJECT_BINARY_DIR}/tests/plugins/examples)
add_dependencies(plugin_test fixture_plugins tinted_light lgabench_perturbations)
