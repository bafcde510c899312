// A second descriptor: which is meant?
#include "../fixture.hpp"

namespace {

[[gnu::used]] constexpr lgabench::PluginDescriptor second_descriptor =
    lgabench::describe_plugin("method", "", "second", "0.1", "the other one", LGABENCH_FINGERPRINT, "{}");

}  // namespace

LGABENCH_METHOD("two_descriptors", "0.1", "has two descriptors", fixture::FixtureMethod<fixture::StayPolicy>, "{}")
