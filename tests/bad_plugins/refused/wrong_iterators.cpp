// CMake compiles this with libstdc++'s debug containers.
#include "../fixture.hpp"

LGABENCH_METHOD("wrong_iterators", "0.1", "built with debug iterators", fixture::FixtureMethod<fixture::StayPolicy>,
                "{}")
