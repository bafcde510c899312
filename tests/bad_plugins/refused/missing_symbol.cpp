// Calls a function that no library has. Its descriptor is fine: only opening it shows.
#include "../fixture.hpp"

namespace lgabench {
int not_in_this_sdk(int);
}

namespace {

class P : public fixture::StayPolicy {
 public:
  void reset() override { lgabench::not_in_this_sdk(1); }
};

}  // namespace

LGABENCH_METHOD("missing_symbol", "0.1", "calls a function that is nowhere", fixture::FixtureMethod<P>, "{}")
