#include <lgabench/learning/loss.hpp>

#include <cmath>

namespace lgabench {

double loss_and_gradient(Loss loss, const float* output, const float* label, int count, double weight,
                         float* gradient) {
  double squared = 0;
  for (int i = 0; i < count; ++i) {
    const double error = double{output[i]} - label[i];
    squared += error * error;
  }
  const double norm = std::sqrt(squared);
  const double scale = loss == Loss::squared ? 2 : norm > 0 ? 1 / norm : 0;
  for (int i = 0; i < count; ++i) gradient[i] = static_cast<float>(weight * scale * (double{output[i]} - label[i]));
  return loss == Loss::norm ? norm : squared;
}

}  // namespace lgabench
