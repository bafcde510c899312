// A perturbation of what is not perceived.
#include <lgabench/plugin/plugin.hpp>

namespace {

class Axis : public lgabench::ObservationPerturbation {
 public:
  lgabench::Observation perceive(lgabench::Observation seen, int, lgabench::RandomStream) override { return seen; }
};

}  // namespace

LGABENCH_PERTURBATION("bad_axis", "0.1", "Other words", Axis, R"({"levels": ["a synonym"], "changes": ["words"]})")
