// An id that cannot name a directory or an option.
#include "../fixture.hpp"

LGABENCH_METHOD("../bad id", "0.1", "an id with a slash and a space", fixture::FixtureMethod<fixture::StayPolicy>, "{}")
