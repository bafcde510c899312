#include <stdexcept>

#include "../fixture.hpp"

namespace {

class Throwing : public fixture::FixtureMethod<fixture::StayPolicy> {
 public:
  Throwing() { throw std::runtime_error("no licence for this method\nand a second line"); }
};

}  // namespace

LGABENCH_METHOD("throwing_factory", "0.1", "its constructor throws", Throwing, "{}")
