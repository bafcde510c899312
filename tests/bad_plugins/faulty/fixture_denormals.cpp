#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "../fixture.hpp"

namespace {

class P : public fixture::StayPolicy {
 public:
  lgabench::Action act(const lgabench::Observation& observation, const lgabench::Instruction& instruction) override {
#if defined(__SSE2__)
    _mm_setcsr(0x1f80);  // the processor's default: subnormal numbers are kept
#endif
    return StayPolicy::act(observation, instruction);
  }
};

}  // namespace

LGABENCH_METHOD("fixture_denormals", "0.1", "switches flush-to-zero off", fixture::FixtureMethod<P>, "{}")
