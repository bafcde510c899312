#include <lgabench/learning/tower.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <lgabench/core/error.hpp>

namespace lgabench {

constexpr float leak = .01f;  // PyTorch's default

Tower::Tower(int channels, Architecture architecture, Parameters& parameters, const Kernels& kernels)
    : architecture_(architecture), parameters_(parameters), kernels_(kernels) {
  const auto first = std::find_if(std::begin(layers), layers + convolution2,
                                  [channels](const Layer& layer) { return layer.channels == channels; });
  if (first == layers + convolution2)
    throw InputError(fmt::format("network: expected pictures of 1, 3 or 4 channels, got {}", channels));
  for (const Layer& layer : {*first, layers[convolution2], layers[convolution3]}) add_convolution(layer);
  first_.emplace(convolutions_[0].layer, kernels);
  transposed_ = Numbers(size(layers[convolution2].weights()));
}

void Tower::add_convolution(const Layer& l) {
  Convolution& c =
      convolutions_.emplace_back(Convolution{l, parameters_.take(l.weights()), parameters_.take(l.out_channels)});
  const double bound = 1 / std::sqrt(l.kernel * l.segment());
  std::vector<std::size_t> places;
  for (int out = 0; out < l.out_channels; ++out)
    for (int in = 0; in < l.channels; ++in)
      for (int y = 0; y < l.kernel; ++y)
        for (int x = 0; x < l.kernel; ++x)
          places.push_back(c.weights + size((y * l.segment() + x * l.channels + in) * l.out_channels + out));
  for (int out = 0; out < l.out_channels; ++out) places.push_back(c.bias + size(out));
  parameters_.uniform(places, -bound, bound);
  if (architecture_ != Architecture::plain) c.norm.emplace(l.out_channels, parameters_, kernels_);
}

void Tower::make_room(int rows) {
  for (Convolution& c : convolutions_) {
    const std::size_t numbers = size(rows * c.layer.outputs());
    for (Numbers* array : {&c.outputs, &c.gradients}) *array = Numbers(numbers);
    if (c.norm) c.values = Numbers(numbers);
  }
  first_->make_room(rows);
  in_.resize(size(rows));
}

const float* Tower::input(std::size_t i, const std::vector<const float*>& pictures, int row) const {
  return i == 0 ? pictures[size(row)] : convolutions_[i - 1].outputs + row * convolutions_[i].layer.inputs();
}

const float* Tower::forward(const std::vector<const float*>& pictures, const float* usual, bool training) {
  rows_ = static_cast<int>(pictures.size());
  mostly_usual_ = first_->find(pictures, usual, rows_);
  for (std::size_t i = 0; i < convolutions_.size(); ++i) {
    Convolution& c = convolutions_[i];
    const int positions = c.positions(rows_), numbers = rows_ * c.layer.outputs();
    float* const values = c.norm ? c.values : c.outputs;
    convolve(i, pictures, values);
    if (architecture_ == Architecture::released && is_last(i))
      for (int k = 0; k < numbers; ++k) values[k] = values[k] > 0 ? values[k] : leak * values[k];
    if (c.norm && training) c.norm->train(values, positions, c.outputs, architecture_ == Architecture::text);
    if (c.norm && !training) c.norm->apply(values, positions, c.outputs, architecture_ == Architecture::text);
  }
  return convolutions_.back().outputs;
}

// With a ReLU where it comes next.
void Tower::convolve(std::size_t i, const std::vector<const float*>& pictures, float* out) {
  const Convolution& c = convolutions_[i];
  const Layer& l = c.layer;
  const bool relu = architecture_ == Architecture::plain || (architecture_ == Architecture::released && !is_last(i));
  const float* const weights = parameters_[c.weights];
  if (i == 0 && mostly_usual_) return first_->forward(weights, parameters_[c.bias], relu, out);
  for (int row = 0; row < rows_; ++row)
    kernels_.forward(l, input(i, pictures, row), weights, parameters_[c.bias], out + row * l.outputs(), relu, nullptr);
}

void Tower::backward(const std::vector<const float*>& pictures) {
  for (std::size_t i = convolutions_.size(); i-- > 0;) backward(i, pictures);
}

void Tower::backward(std::size_t i, const std::vector<const float*>& pictures) {
  Convolution& c = convolutions_[i];
  const Layer& l = c.layer;
  const int positions = c.positions(rows_), numbers = rows_ * l.outputs();
  const bool norm_last = architecture_ == Architecture::released;
  if (c.norm)
    c.norm->backward(c.values, norm_last ? nullptr : static_cast<const float*>(c.outputs), positions, c.gradients);
  if (norm_last && is_last(i))
    for (int k = 0; k < numbers; ++k) c.gradients[k] *= c.values[k] > 0 ? 1 : leak;
  else if (architecture_ != Architecture::text)
    kernels_.relu_gradient(norm_last ? c.values : c.outputs, c.gradients, size(numbers));

  float* const bias_gradient = parameters_.gradient(c.bias);
  if (architecture_ == Architecture::text)  // there the mean takes the bias away again
    std::fill_n(bias_gradient, l.out_channels, 0.f);
  else
    kernels_.sum_rows(c.gradients, bias_gradient, positions, l.out_channels);

  if (i > 0) {
    transpose_weights(l, parameters_[c.weights], transposed_);
    float* const in = convolutions_[i - 1].gradients;
    std::fill_n(in, rows_ * l.inputs(), 0.f);
    for (int row = 0; row < rows_; ++row)
      kernels_.input_gradient(l, c.gradients + row * l.outputs(), transposed_, in + row * l.inputs(), nullptr);
  }
  float* const weight_gradient = parameters_.gradient(c.weights);
  if (i == 0 && mostly_usual_) {
    first_->weight_gradient(c.gradients, weight_gradient);
  } else {
    for (int row = 0; row < rows_; ++row) in_[size(row)] = input(i, pictures, row);
    kernels_.weight_gradient(l, in_.data(), c.gradients, weight_gradient, rows_, nullptr);
  }
}

}  // namespace lgabench
