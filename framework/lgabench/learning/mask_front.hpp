// The first two convolutions of a mask's tower. Most patches of a mask are all 0, and what the first convolution makes
// of those, the background, is the same everywhere. By linearity the second's outputs are those of the background,
// computed once, plus those of each other position's difference from it. Private to learning/.
#pragma once
#include <vector>

#include <lgabench/learning/kernels.hpp>
#include <lgabench/learning/numbers.hpp>
#include <lgabench/learning/zeros.hpp>

namespace lgabench {

/// Without batch normalisation. One thread at a time; a call allocates nothing where make_room() was for as many rows.
class MaskFront {
 public:
  /// @pre `kernels` outlives this.
  explicit MaskFront(const Kernels& kernels);
  /// For batches of up to `rows`.
  void make_room(int rows);

  /// Looks for the patches that are not all 0. False if they are more than half: then this is no gain, and differences
  /// from a background that is hardly there would only add rounding, which Adam makes as large as any gradient.
  bool find(const std::vector<const float*>& pictures, int rows);
  /// Of the pictures that find() took. Weights as in Layer; `out` is rows x 3 x 7 x 64, with ReLU.
  void forward(int rows, const float* weights1, const float* bias1, const float* weights2, const float* bias2,
               float* out);
  /// Of the last forward(), all but the second bias's, from the gradient of `live` channels of its outputs and its sums
  /// over rows and positions.
  void backward(const float* weights2, const Channels& live, const float* gradient, const float* sums,
                float* weight_gradient1, float* bias_gradient1, float* weight_gradient2);

 private:
  // Positions of even and odd row and column are seen through different weights of the second convolution, four each.
  static constexpr int groups = 4, taps = 4;
  static constexpr Layer first_ = layers[mask_convolution], second_ = layers[convolution2];

  Layer on_patches() const;
  Layer of_group(int group, int channels) const;  // as a linear layer
  float* differences(int group) { return differences_ + offsets_[group] * first_.out_channels; }
  void append_patches(const float* picture, int first_place);
  // Calls use(i, tap, o): member i of the group is seen by output position o of the batch; o is -1 where it is not.
  template <class Use>
  void for_taps(int group, const Use& use) const;
  // Calls use(tap, number of the tap's first row of weights).
  template <class Use>
  void for_weights(int group, const Use& use) const;

  const Kernels& kernels_;
  // The patches that are not all 0, and one that is: the background is one more row of everything.
  Numbers patches_, outputs_, gradients_;
  std::vector<int> places_;           // their positions in the batch
  std::vector<int> members_[groups];  // numbers of places
  int offsets_[groups] = {};          // of each group's first row in differences_
  Numbers differences_;               // by group: of each member's outputs from the background; last, the background
  Numbers weights_, seen_, in_gradients_;  // of one group
};

}  // namespace lgabench
