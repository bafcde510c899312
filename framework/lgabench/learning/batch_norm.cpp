#include <lgabench/learning/batch_norm.hpp>

#include <cmath>
#include <numeric>

namespace lgabench {

constexpr double epsilon = 1e-5, momentum = .1;

BatchNorm::BatchNorm(int channels, Parameters& parameters, const Kernels& kernels)
    : channels_(channels),
      parameters_(parameters),
      kernels_(kernels),
      scale_(parameters.take(channels)),
      shift_(parameters.take(channels)),
      running_mean_(size(channels), 0),
      running_variance_(size(channels), 1),
      mean_(size(channels)),
      squares_(size(channels)),
      inverse_deviation_(size(channels)),
      factor_(size(channels)) {
  std::vector<std::size_t> places(size(channels));
  std::iota(places.begin(), places.end(), scale_);
  parameters.uniform(places, 1, 1);
  std::iota(places.begin(), places.end(), shift_);
  parameters.uniform(places, 0, 0);
}

void BatchNorm::train(const float* values, int positions, float* out, bool relu) {
  kernels_.moments(values, positions, channels_, mean_.data(), squares_.data());
  const float* const scale = parameters_[scale_];
  for (std::size_t c = 0; c < mean_.size(); ++c) {
    const double squares = squares_[c];
    inverse_deviation_[c] = static_cast<float>(1 / std::sqrt(squares / positions + epsilon));
    factor_[c] = inverse_deviation_[c] * scale[c];
    running_mean_[c] = static_cast<float>((1 - momentum) * running_mean_[c] + momentum * mean_[c]);
    // The running variance is the unbiased one.
    running_variance_[c] =
        static_cast<float>((1 - momentum) * running_variance_[c] + momentum * squares / (positions - 1));
  }
  kernels_.normalise(values, mean_.data(), factor_.data(), parameters_[shift_], out, positions, channels_, relu);
}

void BatchNorm::apply(const float* values, int positions, float* out, bool relu) {
  const float* const scale = parameters_[scale_];
  for (std::size_t c = 0; c < factor_.size(); ++c)
    factor_[c] = static_cast<float>(scale[c] / std::sqrt(running_variance_[c] + epsilon));
  kernels_.normalise(values, running_mean_.data(), factor_.data(), parameters_[shift_], out, positions, channels_,
                     relu);
}

void BatchNorm::backward(const float* values, const float* out, int positions, float* gradient) {
  kernels_.norm_gradient(values, mean_.data(), inverse_deviation_.data(), parameters_[scale_], out, gradient, positions,
                         channels_, parameters_.gradient(scale_), parameters_.gradient(shift_));
}

}  // namespace lgabench
