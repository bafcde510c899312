// A policy that keeps spatial positions and is trained. A heat map over the table says where to take hold; the rest is
// done as it was shown. Beyond the paper: with a goal mask and with pixels alone, it tells what an abstraction is worth
// to a policy that need not learn where pixels are.
#pragma once
#include <memory>
#include <vector>

#include <lgabench/learning/learner.hpp>

namespace lgabench {

/// Sees signed masks (shrink_mask()) of whole multiples of 32 x 64, mostly the native size, as two planes of 32 x 64,
/// what is to be taken and what is to be avoided apart; colours of 32 x 64, without what most pictures share; a text.
/// At least one picture.
///
/// The taken point is, with a mask (the first), the first place of the demonstrated action where most begin on the
/// target, else (a sweep) the CentroidRule's; without a mask that place. The map (HeatMapNetwork) is trained towards a
/// Gaussian of .015 m about it, within the mask, with the logarithm of the target's share of a cell as prior. Acting:
/// the peak of the map smoothed over 3x3 cells, the expectation within .05 m of it, and onto_target(). The rest is
/// Motion's: in one group where the demonstrations' later places vary by at most .05 m in their frames, else in groups
/// by direction of push, the likeliest of which the network names.
///
/// Where actions have stations, a second network of the same kind is trained towards the demonstrated station's place
/// in the picture, within the second set of a mask that tells it, else of all of a mask; acting, the action is led to
/// the station that is seen nearest to that map's peak.
///
/// 300 steps of 16 samples (of all where there are fewer), rounded up to whole passes, so one pass of more than 4800.
/// Adam, learning rate .003 falling as a cosine. Lengths are the tabletop's metres; elsewhere, the same numbers in the
/// unit that Field has.
class HeatMap : public Learner {
 public:
  static constexpr PictureSize rgb_size{32, 64};

  /// @throws InputError for a shape without a picture, or with pictures of another size, and for actions without a
  /// place in the picture.
  /// `copy_penalty` weighs the cross entropy between a copy's map and that of the row it was made of; 0: it does not
  /// count.
  HeatMap(const SampleShape& shape, std::uint64_t seed, double copy_penalty = 0);
  ~HeatMap() override;
  HeatMap(const HeatMap&) = delete;
  HeatMap& operator=(const HeatMap&) = delete;

  TrainingOptions schedule(const TrainingOptions& asked, int samples) const override;
  void begin(const Samples& samples) override;
  /// The mean demonstrated action where a mask shows no target, or never showed one.
  const std::vector<float>& predict(const Samples& samples) override;
  /// Of each feature of HeatMapNetwork the highest and the mean of all cells; the text.
  std::vector<float> features(const Samples& samples) override;
  /// Samples whose mask shows nothing near the taken point have no gradient.
  double backward(const Samples& samples, const std::vector<int>& batch) override;
  void update(double learning_rate) override;
  std::vector<float> parameters() const override;
  bool learned(Archive& archive) override;

  /// Parameters and gradients of the first network, for tests. @pre begin(). set_parameters() @throws InputError for
  /// another number of them.
  void set_parameters(const std::vector<float>& parameters);
  std::vector<float> gradients() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lgabench
