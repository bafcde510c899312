// A kind of plugin that there is not.
#include <lgabench/plugin/plugin.hpp>

namespace {

[[gnu::section(".lgabench"), gnu::used]] constexpr lgabench::PluginDescriptor descriptor = lgabench::describe_plugin(
    "sampler", "", "wrong_kind", "0.1", "no method and no engine", LGABENCH_FINGERPRINT, "{}");

}  // namespace
