#include <lgabench/learning/network.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>

#include <lgabench/core/error.hpp>
#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/learning/batch_norm.hpp>

namespace lgabench {
namespace {

std::size_t size(int count) { return static_cast<std::size_t>(count); }

// Numbers that begin at a cache line, all 0 at first.
class Numbers {
 public:
  Numbers() = default;
  explicit Numbers(std::size_t count)
      : values_(static_cast<float*>(std::aligned_alloc(64, (count * sizeof(float) + 63) / 64 * 64))) {
    if (!values_) throw std::bad_alloc();
    std::memset(values_.get(), 0, count * sizeof(float));
  }
  operator float*() { return values_.get(); }
  operator const float*() const { return values_.get(); }

 private:
  struct Free {
    void operator()(float* values) const { std::free(values); }
  };
  std::unique_ptr<float[], Free> values_;
};

// Of a parameter's first value.
struct Range {
  double low, high;
};
Range within(int fan_in) { return {-1 / std::sqrt(fan_in), 1 / std::sqrt(fan_in)}; }

// A layer's place in the flat arrays of parameters and gradients.
struct Trained {
  LayerKind kind;
  std::size_t weights = 0, bias = 0, scale = 0, shift = 0;
  Numbers transposed{};  // weights with the last two dimensions exchanged, for the input's gradient

  const Layer& layer() const { return layers[kind]; }
};

struct Convolution : Trained {
  explicit Convolution(LayerKind k) : Trained{k} {}
  Numbers outputs, gradients;  // batch x out rows x out columns x out channels
  std::optional<BatchNorm> norm{};
};

struct Tower {
  std::vector<Convolution> convolutions;
  Trained head{tower_head};
};

}  // namespace

Samples::Samples(const NetworkShape& shape, int count) : rows(count) {
  const auto n = size(count);
  for (const int channels : shape.channels) pictures.emplace_back(n * size(channels) * input_pixels);
  if (shape.text) text.resize(n * text_size);
  labels.resize(n * action_size);
}

struct Network::Impl {
  const Kernels& kernels;
  const NetworkShape shape;
  std::vector<Tower> towers;
  Trained text{text_linear}, text_head_layer{text_head};
  std::size_t head_bias = 0;
  std::size_t count = 0;                  // of parameters, padding included
  std::vector<std::size_t> from_pytorch;  // place in the flat arrays of each of PyTorch's parameters
  Numbers parameters, gradients, mean, variance;
  long long steps = 0;
  // Of one batch:
  int capacity = 0;
  Numbers text_inputs, text_outputs, text_gradients, outputs, part, output_gradients;
  std::vector<const float*> pictures;

  Impl(const NetworkShape& wanted, std::uint64_t seed, const Kernels& used) : kernels(used), shape(wanted) {
    for (const int channels : shape.channels) {
      if (channels != 1 && channels != 3)
        throw InputError(fmt::format("network: expected pictures of 1 or 3 channels, got {}", channels));
      Tower& tower = towers.emplace_back();
      for (const LayerKind kind : {channels == 1 ? mask_convolution : rgb_convolution, convolution2, convolution3}) {
        Convolution& c = tower.convolutions.emplace_back(kind);
        if (shape.batch_norm) c.norm.emplace(c.layer().out_channels);
      }
    }
    const std::vector<Range> ranges = lay_out();
    for (Numbers* array : {&parameters, &gradients, &mean, &variance}) *array = Numbers(count);
    RandomStream random(fmt::format("learning/weights/{}", seed));
    for (std::size_t i = 0; i < ranges.size(); ++i)
      parameters[from_pytorch[i]] = static_cast<float>(random.uniform(ranges[i].low, ranges[i].high));
  }

  // Gives every layer its place, and says between what each parameter begins, in PyTorch's order.
  std::vector<Range> lay_out() {
    std::vector<Range> ranges;
    const auto take = [&](int numbers) {
      const std::size_t begin = count;
      count += size((numbers + 15) / 16 * 16);  // whole vectors
      return begin;
    };
    const auto name = [&](std::size_t place, Range range) {
      from_pytorch.push_back(place);
      ranges.push_back(range);
    };
    for (Tower& tower : towers)
      for (Convolution& c : tower.convolutions) {
        const Layer& l = c.layer();
        const Range range = within(l.kernel * l.segment());
        c.weights = take(l.weights());
        c.bias = take(l.out_channels);
        for (int out = 0; out < l.out_channels; ++out)
          for (int in = 0; in < l.channels; ++in)
            for (int y = 0; y < l.kernel; ++y)
              for (int x = 0; x < l.kernel; ++x)
                name(c.weights + size((y * l.segment() + x * l.channels + in) * l.out_channels + out), range);
        for (int out = 0; out < l.out_channels; ++out) name(c.bias + size(out), range);
        if (!c.norm) continue;
        c.scale = take(l.out_channels);
        c.shift = take(l.out_channels);
        for (int out = 0; out < l.out_channels; ++out) name(c.scale + size(out), {1, 1});
        for (int out = 0; out < l.out_channels; ++out) name(c.shift + size(out), {0, 0});
      }
    if (shape.text) {
      const Range range = within(text_size);
      text.weights = take(text.layer().weights());
      text.bias = take(padded_text_features);
      for (int out = 0; out < text_features; ++out)
        for (int in = 0; in < text_size; ++in) name(text.weights + size(in * padded_text_features + out), range);
      for (int out = 0; out < text_features; ++out) name(text.bias + size(out), range);
    }
    lay_out_head(take, name);
    return ranges;
  }

  template <class Take, class Name>
  void lay_out_head(const Take& take, const Name& name) {
    const int features =
        static_cast<int>(towers.size()) * layers[tower_head].channels + (shape.text ? text_features : 0);
    const Range range = within(features);
    for (Tower& tower : towers) tower.head.weights = take(tower.head.layer().weights());
    if (shape.text) text_head_layer.weights = take(text_head_layer.layer().weights());
    head_bias = take(padded_action);
    for (int out = 0; out < action_size; ++out) {
      for (const Tower& tower : towers) {
        // PyTorch flattens channels first.
        const Layer& last = layers[convolution3];
        const int positions = last.out_rows() * last.out_columns();
        for (int channel = 0; channel < last.out_channels; ++channel)
          for (int position = 0; position < positions; ++position)
            name(tower.head.weights + size((position * last.out_channels + channel) * padded_action + out), range);
      }
      if (shape.text)
        for (int in = 0; in < text_features; ++in)
          name(text_head_layer.weights + size(in * padded_action + out), range);
    }
    for (int out = 0; out < action_size; ++out) name(head_bias + size(out), range);
  }

  void make_room(int rows) {
    if (rows <= capacity) return;
    for (Tower& tower : towers)
      for (Convolution& c : tower.convolutions) {
        c.outputs = Numbers(size(rows * c.layer().outputs()));
        c.gradients = Numbers(size(rows * c.layer().outputs()));
      }
    if (shape.text) {
      text_inputs = Numbers(size(rows * text_size));
      text_outputs = Numbers(size(rows * padded_text_features));
      text_gradients = Numbers(size(rows * padded_text_features));
    }
    outputs = Numbers(size(rows * padded_action));
    part = Numbers(size(rows * padded_action));
    output_gradients = Numbers(size(rows * padded_action));
    pictures.resize(size(rows));
    capacity = rows;
  }

  // Points `pictures` at the inputs of a tower's convolution number `i`.
  void point_at_inputs(std::size_t t, std::size_t i, const Samples& samples, const int* batch, int rows) {
    const std::vector<Convolution>& convolutions = towers[t].convolutions;
    const int inputs = convolutions[i].layer().inputs();
    for (int row = 0; row < rows; ++row)
      pictures[size(row)] = i == 0 ? samples.pictures[t].data() + size(batch[row]) * size(inputs)
                                   : convolutions[i - 1].outputs + row * inputs;
  }

  static int positions(const Convolution& c, int rows) { return rows * c.layer().out_rows() * c.layer().out_columns(); }

  // Leaves the batch's outputs, rows x padded_action.
  void forward(const Samples& samples, const int* batch, int rows, bool training) {
    make_room(rows);
    for (std::size_t t = 0; t < towers.size(); ++t)
      for (std::size_t i = 0; i < towers[t].convolutions.size(); ++i) {
        Convolution& c = towers[t].convolutions[i];
        point_at_inputs(t, i, samples, batch, rows);
        for (int row = 0; row < rows; ++row)
          kernels.of[c.kind].forward(pictures[size(row)], parameters + c.weights, parameters + c.bias,
                                     c.outputs + row * c.layer().outputs(), !c.norm, 0);
        if (!c.norm) continue;
        if (training)
          c.norm->train(c.outputs, positions(c, rows), parameters + c.scale, parameters + c.shift);
        else
          c.norm->apply(c.outputs, positions(c, rows), parameters + c.scale, parameters + c.shift);
        for (int k = 0; k < rows * c.layer().outputs(); ++k) c.outputs[k] = std::max(c.outputs[k], 0.f);
      }
    if (shape.text) {
      for (int row = 0; row < rows; ++row)
        std::copy_n(samples.text.data() + size(batch[row]) * text_size, text_size, text_inputs + row * text_size);
      kernels.of[text_linear].forward(text_inputs, parameters + text.weights, parameters + text.bias, text_outputs,
                                      false, rows);
    }
    for (int row = 0; row < rows; ++row)
      std::copy_n(parameters + head_bias, padded_action, outputs + row * padded_action);
    for (Tower& tower : towers) add_head(tower.head, tower.convolutions.back().outputs, rows);
    if (shape.text) add_head(text_head_layer, text_outputs, rows);
  }

  void add_head(const Trained& head, const float* features, int rows) {
    static const float no_bias[padded_action] = {};
    kernels.of[head.kind].forward(features, parameters + head.weights, no_bias, part, false, rows);
    for (int i = 0; i < rows * padded_action; ++i) outputs[i] += part[i];
  }

  void transpose(Trained& trained) {
    const Layer& l = trained.layer();
    const int columns = l.out_channels, rows = l.segment();
    if (!trained.transposed) trained.transposed = Numbers(size(l.weights()));
    for (int k = 0; k < l.kernel; ++k) {
      const float* const from = parameters + trained.weights + k * rows * columns;
      float* const to = trained.transposed + k * rows * columns;
      for (int c = 0; c < columns; ++c)
        for (int r = 0; r < rows; ++r) to[c * rows + r] = from[r * columns + c];
    }
  }

  // Leaves every gradient, given that of the outputs.
  void backward(const Samples& samples, const int* batch, int rows) {
    kernels.sum_rows(output_gradients, gradients + head_bias, rows, padded_action);
    for (std::size_t t = 0; t < towers.size(); ++t) {
      std::vector<Convolution>& convolutions = towers[t].convolutions;
      Convolution& last = convolutions.back();
      backward_head(towers[t].head, last.outputs, last.gradients, rows);
      for (std::size_t i = convolutions.size(); i-- > 0;) {
        Convolution& c = convolutions[i];
        const Layer& l = c.layer();
        kernels.relu_gradient(c.outputs, c.gradients, size(rows * l.outputs()));
        if (c.norm)
          c.norm->backward(c.gradients, positions(c, rows), parameters + c.scale, gradients + c.scale,
                           gradients + c.shift);
        kernels.sum_rows(c.gradients, gradients + c.bias, positions(c, rows), l.out_channels);
        point_at_inputs(t, i, samples, batch, rows);
        kernels.of[c.kind].weight_gradient(pictures.data(), c.gradients, gradients + c.weights, rows, 0);
        if (i == 0) break;
        transpose(c);
        float* const in = convolutions[i - 1].gradients;
        std::fill_n(in, rows * l.inputs(), 0.f);
        for (int row = 0; row < rows; ++row)
          kernels.of[c.kind].input_gradient(c.gradients + row * l.outputs(), c.transposed, in + row * l.inputs(), 0);
      }
    }
    if (!shape.text) return;
    backward_head(text_head_layer, text_outputs, text_gradients, rows);
    kernels.sum_rows(text_gradients, gradients + text.bias, rows, padded_text_features);
    const float* const in = text_inputs;
    kernels.of[text_linear].weight_gradient(&in, text_gradients, gradients + text.weights, 1, rows);
  }

  void backward_head(Trained& head, const float* features, float* feature_gradients, int rows) {
    kernels.of[head.kind].weight_gradient(&features, output_gradients, gradients + head.weights, 1, rows);
    transpose(head);
    std::fill_n(feature_gradients, rows * head.layer().channels, 0.f);
    kernels.of[head.kind].input_gradient(output_gradients, head.transposed, feature_gradients, rows);
  }

  std::vector<float> in_pytorchs_order(const float* values) const {
    std::vector<float> ordered;
    ordered.reserve(from_pytorch.size());
    for (const std::size_t place : from_pytorch) ordered.push_back(values[place]);
    return ordered;
  }
};

Network::Network(const NetworkShape& shape, std::uint64_t seed, const Kernels& kernels) {
  flush_denormals();
  impl_ = std::make_unique<Impl>(shape, seed, kernels);
}

Network::~Network() = default;

std::vector<float> Network::parameters() const { return impl_->in_pytorchs_order(impl_->parameters); }
std::vector<float> Network::gradients() const { return impl_->in_pytorchs_order(impl_->gradients); }

void Network::set_parameters(const std::vector<float>& parameters) {
  const std::vector<std::size_t>& places = impl_->from_pytorch;
  if (parameters.size() != places.size())
    throw InputError(fmt::format("network: expected {} parameters, got {}", places.size(), parameters.size()));
  for (std::size_t i = 0; i < places.size(); ++i) impl_->parameters[places[i]] = parameters[i];
}

std::vector<float> Network::predict(const Samples& samples) {
  std::vector<int> batch(size(samples.rows));
  for (std::size_t i = 0; i < batch.size(); ++i) batch[i] = static_cast<int>(i);
  impl_->forward(samples, batch.data(), samples.rows, false);
  std::vector<float> outputs;
  for (int row = 0; row < samples.rows; ++row) {
    const float* const begin = impl_->outputs + row * padded_action;
    outputs.insert(outputs.end(), begin, begin + action_size);
  }
  return outputs;
}

double Network::backward(const Samples& samples, const std::vector<int>& batch, Loss loss) {
  const int rows = static_cast<int>(batch.size());
  impl_->forward(samples, batch.data(), rows, true);
  double total = 0;
  for (int row = 0; row < rows; ++row)
    total += loss_and_gradient(loss, impl_->outputs + row * padded_action,
                               samples.labels.data() + size(batch[size(row)]) * action_size, 1. / rows,
                               impl_->output_gradients + row * padded_action);
  impl_->backward(samples, batch.data(), rows);
  return total / rows;
}

void Network::update(double learning_rate) {
  constexpr double beta1 = .9, beta2 = .999;
  const auto t = static_cast<double>(++impl_->steps);
  const AdamCoefficients coefficients = {static_cast<float>(beta1),
                                         static_cast<float>(beta2),
                                         1e-8f,
                                         static_cast<float>(1 - beta1),
                                         static_cast<float>(1 - beta2),
                                         static_cast<float>(learning_rate / (1 - std::pow(beta1, t))),
                                         static_cast<float>(1 / std::sqrt(1 - std::pow(beta2, t)))};
  impl_->kernels.adam(coefficients, impl_->gradients, impl_->mean, impl_->variance, impl_->parameters, impl_->count);
}

}  // namespace lgabench
