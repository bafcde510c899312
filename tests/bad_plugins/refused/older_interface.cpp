// Compiled for the plugin interface of 0.2.
#include <lgabench/core/version.hpp>
#undef LGABENCH_PLUGIN_ABI
#define LGABENCH_PLUGIN_ABI 3
#include "../fixture.hpp"

LGABENCH_METHOD("older_interface", "0.1", "made for an older plugin interface",
                fixture::FixtureMethod<fixture::StayPolicy>, "{}")
