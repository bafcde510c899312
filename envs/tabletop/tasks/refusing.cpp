// Refusing: what the command means is brought onto the pallet, or "done" is said where nothing of it stands there.
#include <tabletop/failures.hpp>
#include <tabletop/tasks/pick_and_place.hpp>

namespace lgabench::tabletop {
namespace {

class Refusing final : public PickAndPlace {
 public:
  std::string id() const override { return "refusing"; }
  std::vector<std::string> failures() const override {
    return {failure::bad_placement, failure::too_early,   failure::not_wanted,
            failure::went_on,       failure::lost_wanted, failure::knocked_on};
  }
  std::string example() const override { return "refusing_heart"; }
  bool has_errand() const override { return true; }
  std::vector<std::string> scenario_members() const override { return {"near_miss_sets", "undecided", "may_stop"}; }
  std::vector<std::string> scene_members() const override { return {"is_there"}; }
  std::vector<Layout> layouts() const override { return {PickAndPlace::layouts()[1]}; }
};

}  // namespace

const Task& task_refusing() {
  static const Refusing task;
  return task;
}

}  // namespace lgabench::tabletop
