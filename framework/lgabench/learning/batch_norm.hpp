// Batch normalisation of channels-last numbers (Ioffe and Szegedy 2015), with PyTorch's constants: epsilon 1e-5,
// momentum .1.
#pragma once
#include <vector>

#include <lgabench/learning/archive.hpp>
#include <lgabench/learning/parameters.hpp>

namespace lgabench {

/// Normalises one convolution's outputs, `positions` x channels. The arrays given are the caller's.
class BatchNorm {
 public:
  /// Takes room for its scale (1 at first) and shift (0). @pre both outlive this.
  BatchNorm(int channels, Parameters& parameters, const Kernels& kernels);

  /// Normalises by the batch's own statistics, which move the running ones. Negative numbers become 0 if `relu`.
  void train(const float* values, int positions, float* out, bool relu);
  /// Normalises as train() does, by the running statistics.
  void apply(const float* values, int positions, float* out, bool relu);
  /// Replaces d loss / d out of the last train() by d loss / d value, in place; `out` where train() had a ReLU, else
  /// null.
  void backward(const float* values, const float* out, int positions, float* gradient);
  /// The running statistics.
  void learned(Archive& archive) {
    const std::size_t channels = running_mean_.size();
    archive(running_mean_);
    archive(running_variance_);
    if (running_mean_.size() != channels || running_variance_.size() != channels) Archive::fail();
  }

 private:
  int channels_;
  Parameters& parameters_;
  const Kernels& kernels_;
  std::size_t scale_, shift_;
  std::vector<float> running_mean_, running_variance_;
  std::vector<float> mean_, squares_, inverse_deviation_, factor_;  // of the last call
};

}  // namespace lgabench
