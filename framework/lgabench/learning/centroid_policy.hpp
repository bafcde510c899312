// A policy that keeps spatial positions and trains nothing: it takes hold of the middle of what is to be taken, and
// does the rest as it was shown. Beyond the paper: it separates what an abstraction is worth from learning where pixels
// are.
#pragma once
#include <memory>
#include <vector>

#include <lgabench/learning/learner.hpp>

namespace lgabench {

/// Sees one signed mask (shrink_mask()) of the native size, which tells the target from the avoid set; the mask of
/// LGA's network does not. begin() fits the policy; it trains in no pass and has no parameters.
///
/// The taken point is the centroid of the target's pixels (of the largest piece; in a demonstration, of the piece
/// nearest to where the action begins), moved to the piece's nearest pixel with two more on every side where it is not
/// on such a one. The action's first place is the taken point where most demonstrations begin on the target. Each other
/// coordinate of the places is the demonstrations' mean as it is or relative to the taken point, whichever varies less
/// (spreads below .001 are equal; of equals the latter where most demonstrated places lie on the target). All other
/// numbers are means.
///
/// Where most do not begin on the target (sweep), demonstrations of one direction of push (unit vectors within .15) are
/// a group with means of its own; a scene is given the largest of the groups whose mean direction from the taken point
/// to the centroid of the avoided pixels is nearest, up to .15.
///
/// Where actions have stations, the action is led to the one seen nearest to the centroid of the second set.
class CentroidRule : public Learner {
 public:
  /// @throws InputError for rows of another shape, and for actions without a place in the picture.
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
  bool learned(Archive& archive) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lgabench
