#include <chrono>
#include <thread>

#include "../fixture.hpp"

namespace {

class P : public fixture::StayPolicy {
 public:
  lgabench::Action act(const lgabench::Observation&, const lgabench::Instruction&) override {
    for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
  }
};

}  // namespace

LGABENCH_METHOD("fixture_hang", "0.1", "never returns from act", fixture::FixtureMethod<P>, "{}")
