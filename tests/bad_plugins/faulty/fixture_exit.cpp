#include <cstdlib>

#include "../fixture.hpp"

namespace {

class P : public fixture::StayPolicy {
 public:
  lgabench::Action act(const lgabench::Observation&, const lgabench::Instruction&) override { std::exit(0); }
};

}  // namespace

LGABENCH_METHOD("fixture_exit", "0.1", "ends the process, with status 0, when it acts", fixture::FixtureMethod<P>, "{}")
