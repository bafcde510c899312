// The policy network of the paper's appendix, and its gradients, without a framework: shapes are fixed, buffers are
// kept, and a step allocates nothing. Tests hold it against LibTorch.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include <lgabench/learning/kernels.hpp>
#include <lgabench/learning/loss.hpp>
#include <lgabench/learning/samples.hpp>

namespace lgabench {

/// One thread at a time. Flushes subnormal numbers to zero in the constructing thread.
class Network {
 public:
  /// Weights and biases uniform within 1/sqrt(fan in), as PyTorch's default; linear layers of `released` with
  /// orthogonal weights and biases of 0. A function of the seed alone. @throws InputError for a picture that has
  /// neither 1 nor 3 channels.
  Network(const NetworkShape& shape, std::uint64_t seed, const Kernels& kernels = *available_kernels().front());
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// All trainable numbers, in the order and the layout that PyTorch gives them: for each tower and convolution weight
  /// (out, in, row, column), bias and, with batch normalisation, scale and shift; then the layers of single inputs (the
  /// text's; `released` the towers'), the one that joins them, and `released` with text the last.
  std::vector<float> parameters() const;
  /// Likewise. @throws InputError for another number of them.
  void set_parameters(const std::vector<float>& parameters);
  /// Of the last backward(), likewise. That of a bias before batch normalisation is 0.
  std::vector<float> gradients() const;

  /// Outputs for each row, rows x 12, valid until the next call. With batch normalisation the running statistics are
  /// used. Labels are not read.
  const std::vector<float>& predict(const Samples& samples);
  /// Mean loss over `batch`, which names rows of `samples`; keeps its gradients.
  double backward(const Samples& samples, const std::vector<int>& batch, Loss loss);
  /// One step of Adam (betas .9 and .999, epsilon 1e-8) along the gradients of the last backward().
  void update(double learning_rate);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lgabench
