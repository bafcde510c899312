#include <lgabench/learning/network.hpp>

#include <ATen/ATen.h>
#include <ATen/Parallel.h>
#include <fmt/format.h>
#include <malloc.h>

#include <cmath>

#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/core/random.hpp>

// Of OpenBLAS where ATen uses it: its own pool of threads does not heed at::set_num_threads.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

namespace lgabench {
namespace {

using at::Tensor;

constexpr int tower_features = 160, text_features = 100;

struct Convolution {
  int channels, kernel, stride;
};
constexpr Convolution convolutions[] = {{32, 8, 4}, {64, 4, 2}, {32, 3, 1}};

// Weight and bias, and for a normalised convolution its scale and shift.
struct Layer {
  Tensor weight, bias, scale, shift, mean, variance;
};

void compute_on_one_thread() {
  at::set_num_threads(1);
  if (openblas_set_num_threads) openblas_set_num_threads(1);
  flush_denormals();
  // Buffers of a step are freed and asked for again: giving them back to the system costs a quarter of the step.
  mallopt(M_TRIM_THRESHOLD, 1 << 28);
  mallopt(M_MMAP_THRESHOLD, 1 << 25);  // the most that glibc takes
}

// A tensor over the caller's numbers, valid as long as they are.
Tensor view(const std::vector<float>& values, at::IntArrayRef sizes) {
  return at::from_blob(const_cast<float*>(values.data()), sizes, at::kFloat);
}

}  // namespace

Samples::Samples(const NetworkShape& shape, int count) : rows(count) {
  const auto n = static_cast<std::size_t>(count);
  for (const int channels : shape.channels)
    pictures.emplace_back(n * static_cast<std::size_t>(channels) * input_pixels);
  if (shape.text) text.resize(n * text_size);
  labels.resize(n * action_size);
}

struct Network::Impl {
  NetworkShape shape;
  std::vector<std::vector<Layer>> towers;
  Layer text, head;
  Tensor parameters, gradients;  // flat; every layer's tensors are views of them

  Impl(const NetworkShape& wanted, std::uint64_t seed) : shape(wanted) {
    // The layers are declared one after the other, then laid out in one array.
    std::vector<std::pair<Tensor*, std::vector<std::int64_t>>> declared;
    std::vector<double> bounds;
    const auto declare = [&](Tensor& tensor, std::vector<std::int64_t> sizes, double bound) {
      declared.emplace_back(&tensor, std::move(sizes));
      bounds.push_back(bound);
    };
    const auto declare_layer = [&](Layer& layer, std::vector<std::int64_t> sizes) {
      double fan_in = 1;
      for (std::size_t i = 1; i < sizes.size(); ++i) fan_in *= static_cast<double>(sizes[i]);
      declare(layer.weight, sizes, 1 / std::sqrt(fan_in));
      declare(layer.bias, {sizes[0]}, 1 / std::sqrt(fan_in));
    };
    towers.resize(shape.channels.size());
    for (std::size_t t = 0; t < towers.size(); ++t) {
      towers[t].resize(std::size(convolutions));
      int channels = shape.channels[t];
      for (std::size_t i = 0; i < towers[t].size(); ++i) {
        const Convolution& c = convolutions[i];
        Layer& layer = towers[t][i];
        declare_layer(layer, {c.channels, channels, c.kernel, c.kernel});
        if (shape.batch_norm) {
          declare(layer.scale, {c.channels}, 0);
          declare(layer.shift, {c.channels}, 0);
          layer.mean = at::zeros({c.channels});
          layer.variance = at::ones({c.channels});
        }
        channels = c.channels;
      }
    }
    if (shape.text) declare_layer(text, {text_features, text_size});
    const auto features = static_cast<std::int64_t>(towers.size()) * tower_features + (shape.text ? text_features : 0);
    declare_layer(head, {action_size, features});

    std::int64_t size = 0;
    for (const auto& [tensor, sizes] : declared) size += c10::multiply_integers(sizes);
    parameters = at::empty({size});
    gradients = at::zeros({size});
    RandomStream random(fmt::format("learning/weights/{}", seed));
    std::int64_t begin = 0;
    for (std::size_t i = 0; i < declared.size(); ++i) {
      const auto& [tensor, sizes] = declared[i];
      const std::int64_t count = c10::multiply_integers(sizes);
      float* const values = parameters.data_ptr<float>() + begin;
      for (std::int64_t k = 0; k < count; ++k) values[k] = static_cast<float>(random.uniform(-bounds[i], bounds[i]));
      *tensor = parameters.narrow(0, begin, count).view(sizes).requires_grad_();
      tensor->mutable_grad() = gradients.narrow(0, begin, count).view(sizes);
      begin += count;
    }
    const at::NoGradGuard no_grad;
    for (auto& tower : towers)
      for (Layer& layer : tower)
        if (shape.batch_norm) layer.scale.fill_(1);
  }

  Tensor forward(const Samples& samples, bool training) {
    std::vector<Tensor> features;
    for (std::size_t t = 0; t < towers.size(); ++t) {
      Tensor x = view(samples.pictures[t], {samples.rows, shape.channels[t], input_rows, input_columns});
      for (std::size_t i = 0; i < towers[t].size(); ++i) {
        const Layer& layer = towers[t][i];
        x = at::conv2d(x, layer.weight, layer.bias, convolutions[i].stride);
        if (shape.batch_norm)
          x = at::batch_norm(x, layer.scale, layer.shift, layer.mean, layer.variance, training, .1, 1e-5, false);
        x.relu_();
      }
      features.push_back(x.flatten(1));
    }
    if (shape.text)
      features.push_back(at::linear(view(samples.text, {samples.rows, text_size}), text.weight, text.bias));
    return at::linear(features.size() == 1 ? features[0] : at::cat(features, 1), head.weight, head.bias);
  }
};

Network::Network(const NetworkShape& shape, std::uint64_t seed) {
  compute_on_one_thread();
  impl_ = std::make_unique<Impl>(shape, seed);
}

Network::~Network() = default;

std::size_t Network::size() const { return static_cast<std::size_t>(impl_->parameters.numel()); }
float* Network::parameters() { return impl_->parameters.data_ptr<float>(); }
const float* Network::gradients() const { return impl_->gradients.data_ptr<float>(); }

std::vector<float> Network::predict(const Samples& samples) {
  const at::NoGradGuard no_grad;
  const Tensor outputs = impl_->forward(samples, false).contiguous();
  const float* values = outputs.data_ptr<float>();
  return {values, values + outputs.numel()};
}

double Network::backward(const Samples& samples, Loss loss) {
  const Tensor outputs = impl_->forward(samples, true).contiguous();
  const Tensor gradient = at::empty({samples.rows, action_size});
  const double mean = loss_and_gradient(loss, outputs.data_ptr<float>(), samples.labels.data(), samples.rows,
                                        gradient.data_ptr<float>());
  impl_->gradients.zero_();
  outputs.backward(gradient);
  return mean;
}

}  // namespace lgabench
