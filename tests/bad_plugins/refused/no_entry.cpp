// A descriptor, but nothing that leads to a factory.
#include <lgabench/plugin/plugin.hpp>

namespace {

[[gnu::used]] constexpr lgabench::PluginDescriptor lone_descriptor =
    lgabench::describe_plugin("method", "", "no_entry", "0.1", "exports no entry", LGABENCH_FINGERPRINT, "{}");

}  // namespace
