// Its options lack a default.
#include "../fixture.hpp"

LGABENCH_METHOD("bad_options", "0.1", "an option without a default", fixture::FixtureMethod<fixture::StayPolicy>,
                R"({"epochs": {"help": "passes", "source": "test fixture"}})")
