// Batch normalisation of channels-last numbers (Ioffe and Szegedy 2015), with PyTorch's constants: epsilon 1e-5,
// momentum .1.
#pragma once
#include <vector>

namespace lgabench {

/// Of one convolution's outputs, `positions` x channels. The arrays given are the caller's.
class BatchNorm {
 public:
  explicit BatchNorm(int channels);

  /// In place, with the batch's own statistics, which move the running ones.
  void train(float* values, int positions, const float* scale, const float* shift);
  /// In place, with the running statistics.
  void apply(float* values, int positions, const float* scale, const float* shift) const;
  /// Of the last train(): replaces d loss / d output by d loss / d input, in place.
  void backward(float* gradient, int positions, const float* scale, float* scale_gradient, float* shift_gradient);

 private:
  int channels_;
  std::vector<float> running_mean_, running_variance_;
  std::vector<float> normalised_;         // of the last train(), positions x channels
  std::vector<float> inverse_deviation_;  // likewise, by channel
};

}  // namespace lgabench
