// A policy that keeps places and trains nothing: it takes hold of the middle of what is to be taken, and does the rest
// as it was shown. Beyond the paper: it separates what an abstraction is worth from learning where pixels are.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include <lgabench/core/action.hpp>

namespace lgabench {

/// Sees a picture of roles, 128 x 256 of 0, target_role and second_role (goal_mask.hpp): target and avoid set apart,
/// which the mask that LGA's network sees does not tell. Deterministic. One thread.
///
/// The taken point is the centroid of the target's pixels (of several pieces the largest one's; in a demonstration the
/// one's nearest to pose0), moved to the piece's nearest pixel with two more on every side where it is not on such a
/// one. pose0 is the taken point where most demonstrations begin on the target. Each other coordinate of the positions
/// is the demonstrations' mean on the table or relative to the taken point, whichever varies less (spreads below 1 mm
/// are equal; of equals the latter where most demonstrated positions lie on the target). Rotations are means.
///
/// Where most do not begin on the target (sweep), demonstrations of one direction of push (unit vectors within .15) are
/// a group with means of its own; a scene is given the largest of the groups whose mean direction from the taken point
/// to the centroid of the avoided pixels is nearest, up to .15.
class CentroidRule {
 public:
  CentroidRule();
  ~CentroidRule();
  CentroidRule(const CentroidRule&) = delete;
  CentroidRule& operator=(const CentroidRule&) = delete;

  /// A demonstrated step. @throws InputError if `roles` is not 128 x 256.
  void add(const std::vector<std::uint8_t>& roles, const Action& label);
  /// After the last add(). @throws MethodError without a demonstration.
  void fit();
  /// After fit(); the mean demonstrated action where nothing of the target is seen. @throws InputError as add().
  Action act(const std::vector<std::uint8_t>& roles);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lgabench
