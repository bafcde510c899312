// Pick-and-place: bring the target onto the pallet. Errands do it again and again.
#pragma once
#include <string>
#include <vector>

#include <tabletop/task.hpp>

namespace lgabench::tabletop {

class PickAndPlace : public Task {
 public:
  std::string id() const override { return "pick_and_place"; }
  std::vector<std::string> failures() const override { return {failure::bad_placement}; }
  std::string example() const override { return "heart"; }
  std::vector<Layout> layouts() const override;
  std::vector<Polygon> room(const Layout& layout, const SceneObject& target) const override;
  int most_distractors() const override { return 6; }
  TwoPoses expert_action(const Scene& scene, const std::vector<Pose>& poses, const PhysicsWorld& world,
                         std::size_t object) const override;
  Failure judge(const Scene& scene, const Final& target, const std::vector<Final>& finals,
                const JudgeLimits& limits) const override;
  double off_m(const Scene& scene, const Final& target, const std::vector<Final>& finals) const override;
  std::vector<Gap> gaps(const Scene& scene, const Final& target, const std::vector<Final>& finals,
                        const Motion& motion) const override;
};

}  // namespace lgabench::tabletop
