#include "../fixture.hpp"

LGABENCH_METHOD("fixture_fast_math", "0.1", "is built with -ffast-math", fixture::FixtureMethod<fixture::StayPolicy>,
                "{}")
