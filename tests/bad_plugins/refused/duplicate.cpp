// Has the id of another plugin.
#include "../fixture.hpp"

LGABENCH_METHOD("fixture_constant", "0.2", "takes another's id", fixture::FixtureMethod<fixture::StayPolicy>, "{}")
