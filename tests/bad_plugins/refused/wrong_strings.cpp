// CMake compiles this with the old string ABI of libstdc++.
#include "../fixture.hpp"

LGABENCH_METHOD("wrong_strings", "0.1", "built with the old string ABI", fixture::FixtureMethod<fixture::StayPolicy>,
                "{}")
