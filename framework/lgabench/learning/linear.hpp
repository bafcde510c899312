// A matrix between rows of numbers. Private to learning/.
#pragma once
#include <vector>

#include <lgabench/learning/parameters.hpp>

namespace lgabench {

/// A linear layer of one input, or that input's share of a layer that joins several. Rows of numbers are padded with
/// zeros to whole vectors. The bias belongs to the layer's owner.
class Linear {
 public:
  /// Takes its weights. @pre both references outlive this.
  Linear(LayerKind kind, Parameters& parameters, const Kernels& kernels);

  /// Places of the weights of one output, in the order in which PyTorch has the inputs.
  std::vector<std::size_t> places(int out) const;
  /// Numbers of a row of its input, padding included.
  int inputs() const { return layer_.channels; }
  /// Numbers of its output.
  int outputs() const { return layer_.out_channels; }

  /// out = in * weights + bias, row by row.
  void forward(const float* in, const float* bias, float* out, int rows) const;
  /// Leaves the weights' gradient, given those of the outputs; writes that of `in` unless it is null.
  void backward(const float* in, const float* gradient, float* in_gradient, int rows);

 private:
  Layer on(int rows) const;  // with a batch of so many rows

  Layer layer_;
  Parameters& parameters_;
  const Kernels& kernels_;
  std::size_t weights_;
  Numbers transposed_;
};

}  // namespace lgabench
