#include <stdexcept>

#include "../fixture.hpp"

namespace {

class P : public fixture::StayPolicy {
 public:
  lgabench::Action act(const lgabench::Observation&, const lgabench::Instruction&) override {
    throw std::runtime_error("the fixture's own failure");
  }
};

}  // namespace

LGABENCH_METHOD("fixture_throw", "0.1", "throws when it acts", fixture::FixtureMethod<P>, "{}")
