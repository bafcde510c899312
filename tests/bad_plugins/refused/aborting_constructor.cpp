// A static initialiser that kills whoever opens the library: list and info must not.
#include <cstdlib>

#include "../fixture.hpp"

namespace {

const struct Killer {
  Killer() { std::abort(); }
} killer;

}  // namespace

LGABENCH_METHOD("aborting_constructor", "0.1", "aborts when it is opened", fixture::FixtureMethod<fixture::StayPolicy>,
                "{}")
