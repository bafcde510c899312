// The policy network of the paper's appendix, and its gradients, without a framework: shapes are fixed, buffers are
// kept, and a step allocates nothing. Tests hold it against LibTorch.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include <lgabench/learning/kernels.hpp>
#include <lgabench/learning/learner.hpp>
#include <lgabench/learning/loss.hpp>
#include <lgabench/learning/network_shape.hpp>

namespace lgabench {

/// One thread at a time. Flushes subnormal numbers to zero in the constructing thread.
class Network : public Learner {
 public:
  /// Weights and biases uniform within 1/sqrt(fan in), as PyTorch's default; linear layers of `released` with
  /// orthogonal weights and biases of 0. A function of the seed alone. @throws InputError for a picture whose
  /// channels are none of 1, 3 and 4.
  Network(const NetworkShape& shape, std::uint64_t seed, Loss loss = Loss::norm,
          const Kernels& kernels = *available_kernels().front());
  ~Network() override;
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// All trainable numbers, in the order and the layout that PyTorch gives them: for each tower and convolution weight
  /// (out, in, row, column), bias and, with batch normalisation, scale and shift; then the layers of single inputs (the
  /// text's; `released` the towers'), the one that joins them, and `released` with text the last.
  std::vector<float> parameters() const override;
  /// Sets the parameters, in the same order. @throws InputError for another number of them.
  void set_parameters(const std::vector<float>& parameters);
  /// Gradients of the last backward(), in the same order. That of a bias before batch normalisation is 0.
  std::vector<float> gradients() const;

  /// Finds what most pictures share, which makes a step faster and changes its rounding. `plain` does without, to keep
  /// the bits of earlier versions.
  void begin(const Samples& samples) override;
  /// With batch normalisation the running statistics are used.
  const std::vector<float>& predict(const Samples& samples) override;
  /// Of the towers, the text and the state.
  std::vector<float> features(const Samples& samples) override;
  double backward(const Samples& samples, const std::vector<int>& batch) override;
  /// One step of Adam (betas .9 and .999, epsilon 1e-8).
  void update(double learning_rate) override;
  bool learned(Archive& archive) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lgabench
