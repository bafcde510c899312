#include <lgabench/learning/batch_norm.hpp>

#include <cmath>

namespace lgabench {

constexpr double epsilon = 1e-5, momentum = .1;

BatchNorm::BatchNorm(int channels)
    : channels_(channels),
      running_mean_(static_cast<std::size_t>(channels), 0),
      running_variance_(static_cast<std::size_t>(channels), 1),
      inverse_deviation_(static_cast<std::size_t>(channels)) {}

void BatchNorm::train(float* values, int positions, const float* scale, const float* shift) {
  normalised_.resize(static_cast<std::size_t>(positions) * static_cast<std::size_t>(channels_));
  for (int c = 0; c < channels_; ++c) {
    double sum = 0, squares = 0;
    for (int i = 0; i < positions; ++i) sum += values[i * channels_ + c];
    const double mean = sum / positions;
    for (int i = 0; i < positions; ++i) {
      const double distance = values[i * channels_ + c] - mean;
      squares += distance * distance;
    }
    const double inverse = 1 / std::sqrt(squares / positions + epsilon);
    for (int i = 0; i < positions; ++i) {
      const int at = i * channels_ + c;
      normalised_[static_cast<std::size_t>(at)] = static_cast<float>((values[at] - mean) * inverse);
      values[at] = normalised_[static_cast<std::size_t>(at)] * scale[c] + shift[c];
    }
    const auto k = static_cast<std::size_t>(c);
    inverse_deviation_[k] = static_cast<float>(inverse);
    running_mean_[k] = static_cast<float>((1 - momentum) * running_mean_[k] + momentum * mean);
    // The running variance is the unbiased one.
    running_variance_[k] =
        static_cast<float>((1 - momentum) * running_variance_[k] + momentum * squares / (positions - 1));
  }
}

void BatchNorm::apply(float* values, int positions, const float* scale, const float* shift) const {
  for (int i = 0; i < positions; ++i)
    for (int c = 0; c < channels_; ++c) {
      const auto k = static_cast<std::size_t>(c);
      float& value = values[i * channels_ + c];
      value = (value - running_mean_[k]) / std::sqrt(running_variance_[k] + static_cast<float>(epsilon)) * scale[c] +
              shift[c];
    }
}

void BatchNorm::backward(float* gradient, int positions, const float* scale, float* scale_gradient,
                         float* shift_gradient) {
  for (int c = 0; c < channels_; ++c) {
    double sum = 0, along = 0;
    for (int i = 0; i < positions; ++i) {
      const int at = i * channels_ + c;
      sum += gradient[at];
      along += double{gradient[at]} * normalised_[static_cast<std::size_t>(at)];
    }
    shift_gradient[c] = static_cast<float>(sum);
    scale_gradient[c] = static_cast<float>(along);
    const double factor = double{scale[c]} * inverse_deviation_[static_cast<std::size_t>(c)] / positions;
    for (int i = 0; i < positions; ++i) {
      const int at = i * channels_ + c;
      gradient[at] = static_cast<float>(
          factor * (positions * double{gradient[at]} - sum - normalised_[static_cast<std::size_t>(at)] * along));
    }
  }
}

}  // namespace lgabench
