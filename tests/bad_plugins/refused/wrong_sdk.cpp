// Compiled against another version of the framework.
#include <lgabench/core/version.hpp>
#undef LGABENCH_VERSION
#define LGABENCH_VERSION "0.0.9"
#include "../fixture.hpp"

LGABENCH_METHOD("wrong_sdk", "0.1", "built with another SDK", fixture::FixtureMethod<fixture::StayPolicy>, "{}")
