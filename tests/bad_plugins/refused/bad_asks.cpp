// Its descriptor asks whom there is not.
#include "../fixture.hpp"

LGABENCH_METHOD_ASKING("everybody", "bad_asks", "0.1", "asks everybody", fixture::FixtureMethod<fixture::StayPolicy>,
                       "{}")
