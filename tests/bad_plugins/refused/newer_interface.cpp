// Compiled for another version of the plugin interface.
#include <lgabench/core/version.hpp>
#undef LGABENCH_PLUGIN_ABI
#define LGABENCH_PLUGIN_ABI 1000
#include "../fixture.hpp"

LGABENCH_METHOD("newer_interface", "0.1", "made for a newer plugin interface",
                fixture::FixtureMethod<fixture::StayPolicy>, "{}")
