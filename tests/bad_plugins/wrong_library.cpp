// Compiled with Clang's libc++, where that is installed.
#include "fixture.hpp"

LGABENCH_METHOD("wrong_library", "0.1", "built with another standard library",
                fixture::FixtureMethod<fixture::StayPolicy>, "{}")
