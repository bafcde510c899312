// The policy network of the paper's appendix, and its gradients, without a framework: shapes are fixed, buffers are
// kept, and a step allocates nothing. Tests hold it against LibTorch.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <lgabench/learning/inputs.hpp>
#include <lgabench/learning/kernels.hpp>
#include <lgabench/learning/loss.hpp>

namespace lgabench {

/// One tower for each picture: Conv 8x8/4 to 32, 4x4/2 to 64, 3x3/1 to 32 channels, each followed by ReLU, flattened to
/// 160; a text of 384 numbers goes through a linear layer to 100; a last linear layer maps all of it to the action.
struct NetworkShape {
  std::vector<int> channels;  // of each tower's picture: 1 or 3
  bool text = false;
  bool batch_norm = false;  // before each ReLU, as the appendix has it
};

/// Numbers of a sentence embedding.
constexpr int text_size = 384;

/// Rows of input and label, each array row-major.
struct Samples {
  /// All zeros.
  explicit Samples(const NetworkShape& shape, int count);

  int rows;
  std::vector<std::vector<float>> pictures;  // for each tower rows x 36 x 72 x channels
  std::vector<float> text;                   // rows x 384, or empty
  std::vector<float> labels;                 // rows x 12
};

/// One thread at a time. Flushes subnormal numbers to zero in the constructing thread.
class Network {
 public:
  /// Weights and biases uniform within 1/sqrt(fan in), as PyTorch's default, and a function of the seed alone.
  Network(const NetworkShape& shape, std::uint64_t seed, const Kernels& kernels = *available_kernels().front());
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// All trainable numbers, in the order and the layout that PyTorch gives them: for each tower and convolution weight
  /// (out, in, row, column), bias and, with batch normalisation, scale and shift; then the text's and the last layer.
  std::vector<float> parameters() const;
  /// Likewise. @throws InputError for another number of them.
  void set_parameters(const std::vector<float>& parameters);
  /// Of the last backward(), likewise.
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
