#include <lgabench/learning/loss.hpp>

#include <cmath>

namespace lgabench {

double loss_and_gradient(Loss loss, const float* outputs, const float* labels, int rows, float* gradient) {
  double total = 0;
  for (int row = 0; row < rows; ++row) {
    const int begin = row * action_size, end = begin + action_size;
    double squared = 0;
    for (int i = begin; i < end; ++i) squared += (double{outputs[i]} - labels[i]) * (double{outputs[i]} - labels[i]);
    const double norm = std::sqrt(squared);
    total += loss == Loss::norm ? norm : squared;
    const double scale = loss == Loss::squared ? 2 : norm > 0 ? 1 / norm : 0;
    for (int i = begin; i < end; ++i) gradient[i] = static_cast<float>(scale * (double{outputs[i]} - labels[i]) / rows);
  }
  return total / rows;
}

Adam::Adam(std::size_t parameters, double learning_rate)
    : learning_rate_(learning_rate), mean_(parameters), variance_(parameters) {}

void Adam::step(float* parameters, const float* gradients) {
  constexpr double beta1 = .9, beta2 = .999;
  ++steps_;
  const double correction1 = 1 - std::pow(beta1, steps_), correction2 = 1 - std::pow(beta2, steps_);
  const float b1 = beta1, c1 = 1 - beta1, b2 = beta2, c2 = 1 - beta2, epsilon = 1e-8f;
  const auto rate = static_cast<float>(learning_rate_ / correction1);
  const auto root = static_cast<float>(1 / std::sqrt(correction2));
  float* const mean = mean_.data();
  float* const variance = variance_.data();
  for (std::size_t i = 0; i < mean_.size(); ++i) {
    const float g = gradients[i];
    mean[i] = b1 * mean[i] + c1 * g;
    variance[i] = b2 * variance[i] + c2 * g * g;
    parameters[i] -= rate * mean[i] / (std::sqrt(variance[i]) * root + epsilon);
  }
}

}  // namespace lgabench
