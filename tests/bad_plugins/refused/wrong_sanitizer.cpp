// CMake compiles this with AddressSanitizer, or without it where all else has it.
#include "../fixture.hpp"

LGABENCH_METHOD("wrong_sanitizer", "0.1", "built with another sanitizer", fixture::FixtureMethod<fixture::StayPolicy>,
                "{}")
