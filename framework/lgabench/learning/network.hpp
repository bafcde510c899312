// The policy network of the paper's appendix. LibTorch stays behind this interface.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <lgabench/learning/inputs.hpp>
#include <lgabench/learning/loss.hpp>

namespace lgabench {

/// One tower for each picture: Conv 8x8/4 to 32, 4x4/2 to 64, 3x3/1 to 32 channels, each followed by ReLU, flattened to
/// 160; a text of 384 numbers goes through a linear layer to 100; a last linear layer maps all of it to the action.
struct NetworkShape {
  std::vector<int> channels;  // of each tower's picture
  bool text = false;
  bool batch_norm = false;  // before each ReLU, as the appendix has it
};

constexpr int text_size = 384;

/// Rows of input and label, each array row-major.
struct Samples {
  explicit Samples(const NetworkShape& shape, int count);

  int rows;
  std::vector<std::vector<float>> pictures;  // for each tower rows x channels x 36 x 72
  std::vector<float> text;                   // rows x 384, or empty
  std::vector<float> labels;                 // rows x 12
};

/// One thread at a time. Computes on one processor; flushes subnormal numbers to zero in the constructing thread.
class Network {
 public:
  /// Weights and biases uniform within 1/sqrt(fan in), as PyTorch's default, and a function of the seed alone.
  Network(const NetworkShape& shape, std::uint64_t seed);
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// All trainable numbers and the gradients of the last loss, in the same order; owned by the network.
  std::size_t size() const;
  float* parameters();
  const float* gradients() const;

  /// Outputs for each row, rows x 12. With batch normalisation the running statistics are used. Labels are not read.
  std::vector<float> predict(const Samples& samples);
  /// Mean loss over the rows; leaves its gradients in gradients().
  double backward(const Samples& samples, Loss loss);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lgabench
