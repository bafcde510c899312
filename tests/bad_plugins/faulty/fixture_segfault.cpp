#include <csignal>

#include "../fixture.hpp"

namespace {

class P : public fixture::StayPolicy {
 public:
  lgabench::Action act(const lgabench::Observation& observation, const lgabench::Instruction& instruction) override {
    std::raise(SIGSEGV);
    return StayPolicy::act(observation, instruction);
  }
};

}  // namespace

LGABENCH_METHOD("fixture_segfault", "0.1", "dies of a segmentation fault when it acts", fixture::FixtureMethod<P>, "{}")
