// Says one thing in the file, and another once its static initialisers have run.
#include <cstring>

#include <lgabench/plugin/plugin.hpp>

namespace {

lgabench::PluginDescriptor descriptor =
    lgabench::describe_plugin("method", "", "changing_descriptor", "0.1", "modest", LGABENCH_FINGERPRINT, "{}");
const char* const changed = std::strcpy(descriptor.summary, "the best");
void* create() { return nullptr; }

}  // namespace

extern "C" {
[[gnu::visibility("default")]] extern const lgabench::PluginEntry lga_plugin_v1;
const lgabench::PluginEntry lga_plugin_v1{&descriptor, changed ? &create : nullptr};
}
