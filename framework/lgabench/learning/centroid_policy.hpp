// A policy that keeps places and trains nothing: it takes hold of the middle of what is to be taken, and does the rest
// as it was shown. Beyond the paper: it separates what an abstraction is worth from learning where pixels are.
#pragma once
#include <memory>
#include <vector>

#include <lgabench/learning/learner.hpp>

namespace lgabench {

/// Sees one signed mask of 128 x 256 (shrink_mask()): target and avoid set apart, which the mask that LGA's network
/// sees does not tell. Fitted by begin(); trains in no pass and has no parameters.
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
class CentroidRule : public Learner {
 public:
  /// @throws InputError for rows of another shape.
  explicit CentroidRule(const SampleShape& shape);
  ~CentroidRule() override;
  CentroidRule(const CentroidRule&) = delete;
  CentroidRule& operator=(const CentroidRule&) = delete;

  TrainingOptions schedule(const TrainingOptions& asked, int samples) const override;
  void begin(const Samples& samples) override;
  /// The mean demonstrated action where nothing of the target is seen.
  const std::vector<float>& predict(const Samples& samples) override;
  double backward(const Samples&, const std::vector<int>&) override { return 0; }
  void update(double) override {}
  std::vector<float> parameters() const override { return {}; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lgabench
