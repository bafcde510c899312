// An errand as it goes on: what stands on the table, what was brought, and what the end of a motion says of it.
#pragma once
#include <cstddef>
#include <vector>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/scene.hpp>
#include <tabletop/motions.hpp>

namespace lgabench::tabletop {

/// Judges by true names, of what was truly brought. Objects go by their number in the scene. A value.
class Errand {
 public:
  /// @pre the scene has an errand
  explicit Errand(const Scene& scene);

  /// Whether it is there to be seen. The goal always is, what was taken away never.
  bool on_table(std::size_t object) const { return on_table_[object]; }
  /// Names of what was brought, in order.
  const std::vector<Named>& brought() const { return brought_; }
  /// What may be brought next.
  std::vector<std::size_t> wanted() const;
  /// Whether nothing is left to do.
  bool is_done() const;

  /// A motion ended with these poses. What then lies on the goal was brought: the object that suction took before any
  /// that was knocked there. What was brought, and what left the working area, is taken away. After the first take
  /// what the scene says comes later stands on the table. @returns failure::goes_on, or why the episode is over.
  Failure moved(const std::vector<Pose>& poses, const Motion& motion);
  /// The actor says that nothing is left to do. @returns failure::none, or why that is wrong.
  Failure ended() const;

 private:
  std::vector<Named> names_on_table() const;
  bool is_wanted(std::size_t object) const;

  const Scene* scene_;  // the environment's, which outlives it
  std::vector<bool> on_table_;
  std::vector<Named> brought_;
};

/// How far a step is from bringing something that was wanted when it began, as gaps() of a scene with these targets.
/// `errand` and `before`: when the step began. All 0 where nothing was wanted.
std::vector<Gap> errand_gaps(const Scene& scene, const Errand& errand, const TwoPoses& action,
                             const std::vector<Pose>& before, const std::vector<Pose>& poses, const Motion& motion);

}  // namespace lgabench::tabletop
