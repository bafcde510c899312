// The distance between predicted and labelled actions, and Adam: what training minimises and how.
#pragma once
#include <cstddef>
#include <vector>

#include <lgabench/core/action.hpp>

namespace lgabench {

constexpr int action_size = static_cast<int>(ActionVector().size());

/// norm: the un-squared L2 norm over the 12 raw outputs (the default). squared: its square (the paper's text).
enum class Loss { norm, squared };

/// Mean loss over a batch; `outputs`, `labels` and `gradient` are rows x 12. Writes d loss / d outputs to `gradient`;
/// where a row's error is exactly 0, the norm's subgradient 0.
double loss_and_gradient(Loss loss, const float* outputs, const float* labels, int rows, float* gradient);

/// Adam (Kingma and Ba, 2015) in place on flat arrays, with the usual betas .9 and .999 and epsilon 1e-8.
class Adam {
 public:
  Adam(std::size_t parameters, double learning_rate);
  void step(float* parameters, const float* gradients);

 private:
  double learning_rate_;
  long long steps_ = 0;
  std::vector<float> mean_, variance_;
};

}  // namespace lgabench
