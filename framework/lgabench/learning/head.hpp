// From the features of the towers and the text to the action. Private to learning/.
#pragma once
#include <optional>
#include <vector>

#include <lgabench/learning/linear.hpp>
#include <lgabench/learning/loss.hpp>
#include <lgabench/learning/network_shape.hpp>

namespace lgabench {

/// The head of each architecture of network_shape.hpp. One thread at a time; a call allocates nothing where make_room()
/// was for as many rows.
class Head {
 public:
  /// Takes its parameters in PyTorch's order: the layers of single inputs, the one that joins them, the last. They
  /// begin uniform within 1/sqrt(fan in), as PyTorch's default; `released` with orthogonal weights and biases of 0.
  /// @pre both references outlive this.
  Head(const NetworkShape& shape, Parameters& parameters, const Kernels& kernels);
  /// Makes room for batches of up to `rows`.
  void make_room(int rows);

  /// Outputs, rows x 16 of which NetworkShape::actions count, valid until the next call. Inputs are each tower's
  /// features (rows x 160), then the text (rows x 384) if there is one, then the state (rows x 16); backward() reads
  /// them again.
  const float* forward(const std::vector<const float*>& inputs, int rows);
  /// Leaves the parameters' gradients, given that of the outputs, and writes that of each input that is not null.
  void backward(const std::vector<const float*>& inputs, const float* gradient,
                const std::vector<float*>& input_gradients);

 private:
  struct Input {
    std::optional<Linear> linear{};  // a layer of its own, before the join
    std::size_t linear_bias = 0;
    Numbers made{}, gradients{};  // what that makes
    std::optional<Linear> share{};
  };

  // The layers that make one output number after the other have it named and given a beginning.
  void name(const std::vector<const Linear*>& side_by_side, int outs, std::size_t bias);

  const Architecture architecture_;
  Parameters& parameters_;
  const Kernels& kernels_;
  std::vector<Input> inputs_;
  std::size_t joined_bias_ = 0, last_bias_ = 0;
  std::optional<Linear> last_;  // after a ReLU; where there is none the joined layer makes the outputs
  int rows_ = 0;                // of the last batch
  Numbers joined_, part_, joined_gradients_, outputs_;
};

}  // namespace lgabench
