#include <cstdlib>

#include "../fixture.hpp"

namespace {

class P : public fixture::StayPolicy {
 public:
  lgabench::Action act(const lgabench::Observation&, const lgabench::Instruction&) override { std::abort(); }
};

}  // namespace

LGABENCH_METHOD("fixture_abort", "0.1", "aborts when it acts", fixture::FixtureMethod<P>, "{}")
