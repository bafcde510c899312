#include "../fixture.hpp"

namespace {

class Throwing : public fixture::FixtureMethod<fixture::StayPolicy> {
 public:
  Throwing() { throw 7; }
};

}  // namespace

LGABENCH_METHOD("odd_factory", "0.1", "its constructor throws what is no std::exception", Throwing, "{}")
