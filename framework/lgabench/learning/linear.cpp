#include <lgabench/learning/linear.hpp>

#include <algorithm>

namespace lgabench {
namespace {

int without_padding(int channels) {
  return channels == padded_hidden ? hidden_features : channels == padded_wide ? wide_features : channels;
}

}  // namespace

Linear::Linear(LayerKind kind, Parameters& parameters, const Kernels& kernels)
    : layer_(layers[kind]),
      parameters_(parameters),
      kernels_(kernels),
      weights_(parameters.take(layer_.weights())),
      transposed_(size(layer_.weights())) {}

std::vector<std::size_t> Linear::places(int out) const {
  std::vector<std::size_t> places;
  const auto add = [&](int in) { places.push_back(weights_ + size(in * layer_.out_channels + out)); };
  constexpr const Layer& last = layers[convolution3];
  constexpr int positions = last.out_rows() * last.out_columns();
  if (layer_.channels == positions * last.out_channels)  // a tower's, which PyTorch flattens channels first
    for (int channel = 0; channel < last.out_channels; ++channel)
      for (int position = 0; position < positions; ++position) add(position * last.out_channels + channel);
  else
    for (int in = 0; in < without_padding(layer_.channels); ++in) add(in);
  return places;
}

Layer Linear::on(int rows) const {
  Layer l = layer_;
  l.columns = rows;
  return l;
}

void Linear::forward(const float* in, const float* bias, float* out, int rows) const {
  kernels_.forward(on(rows), in, parameters_[weights_], bias, out, false, nullptr);
}

void Linear::backward(const float* in, const float* gradient, float* in_gradient, int rows) {
  kernels_.weight_gradient(on(rows), &in, gradient, parameters_.gradient(weights_), 1, nullptr);
  if (!in_gradient) return;
  transpose_weights(layer_, parameters_[weights_], transposed_);
  std::fill_n(in_gradient, rows * layer_.channels, 0.f);
  kernels_.input_gradient(on(rows), gradient, transposed_, in_gradient, nullptr);
}

}  // namespace lgabench
