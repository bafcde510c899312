// Written without the macro: the factory makes nothing.
#include <lgabench/plugin/plugin.hpp>

namespace {

[[gnu::section(".lgabench")]] constexpr lgabench::PluginDescriptor descriptor = lgabench::describe_plugin(
    "method", "", "null_factory", "0.1", "its factory makes nothing", LGABENCH_FINGERPRINT, "{}");
void* create() { return nullptr; }

}  // namespace

extern "C" {
[[gnu::visibility("default")]] extern const lgabench::PluginEntry lga_plugin_v1;
const lgabench::PluginEntry lga_plugin_v1{&descriptor, &create};
}
