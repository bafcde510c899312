// Errands: what the command wants is brought onto the pallet, one object a step, and taken away from there.
#include <tabletop/failures.hpp>
#include <tabletop/tasks/pick_and_place.hpp>

namespace lgabench::tabletop {
namespace {

class ErrandsTask final : public PickAndPlace {
 public:
  std::string id() const override { return "errands"; }
  std::vector<std::string> failures() const override {
    return {failure::too_early, failure::not_wanted, failure::went_on, failure::lost_wanted, failure::knocked_on};
  }
  std::string example() const override { return "errands_fruit"; }
  int most_steps() const override { return 6; }
  bool has_errand() const override { return true; }
  std::vector<std::string> scenario_members() const override { return {"classes", "pair", "scenes_of"}; }
  std::vector<std::string> scene_members() const override { return {"needed", "appears"}; }
  std::vector<Layout> layouts() const override { return {PickAndPlace::layouts()[1]}; }
  int most_distractors() const override { return 7; }  // with the one that appears
};

}  // namespace

const Task& task_errands() {
  static const ErrandsTask task;
  return task;
}

}  // namespace lgabench::tabletop
