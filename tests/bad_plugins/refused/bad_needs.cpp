// A value of an option needs what another option cannot be.
#include "../fixture.hpp"

LGABENCH_METHOD("bad_needs", "0.1", "needs a value that there is not", fixture::FixtureMethod<fixture::StayPolicy>,
                R"({"see": {"default": "mask", "values": ["mask"], "help": "input", "source": "test fixture"},
                    "way": {"default": "plain", "values": ["plain"], "help": "policy", "source": "test fixture",
                            "needs": {"plain": {"see": ["rgb"]}}}})")
