#include <lgabench/learning/network.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <lgabench/core/error.hpp>
#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/learning/batch_norm.hpp>
#include <lgabench/learning/mask_front.hpp>
#include <lgabench/learning/numbers.hpp>
#include <lgabench/learning/zeros.hpp>

namespace lgabench {
namespace {

// Of a parameter's first value.
struct Range {
  double low, high;
};
Range within(int fan_in) { return {-1 / std::sqrt(fan_in), 1 / std::sqrt(fan_in)}; }

// A layer's place in the flat arrays of parameters and gradients.
struct Trained {
  explicit Trained(LayerKind k)
      : layer(layers[k]), in(all_channels(layer.channels)), out(all_channels(layer.out_channels)) {}

  Layer layer;
  Channels in, out;  // all
  std::size_t weights = 0, bias = 0, scale = 0, shift = 0;

  // A linear layer with a batch of so many rows.
  Layer on(int rows) const {
    Layer l = layer;
    l.columns = rows;
    return l;
  }
};

struct Convolution : Trained {
  using Trained::Trained;
  Channels live = out;         // what is kept of the outputs: the others are 0 in all of this batch
  Numbers outputs, gradients;  // batch x out rows x out columns x live channels
  std::optional<BatchNorm> norm{};

  int positions(int rows) const { return rows * layer.out_rows() * layer.out_columns(); }
};

struct Tower {
  std::vector<Convolution> convolutions;
  Trained head{tower_head};
  std::unique_ptr<MaskFront> front{};  // of a mask: makes the first two convolutions, if this batch is mostly empty
  bool mostly_empty = false;

  std::size_t first() const { return mostly_empty ? 1 : 0; }  // the convolution that sees the pictures

  const Channels& inputs(std::size_t i) const { return i > 0 ? convolutions[i - 1].live : convolutions[0].in; }
  // Convolution number `i` between the channels that are left.
  Layer live_layer(std::size_t i) const {
    Layer l = convolutions[i].layer;
    l.channels = static_cast<int>(inputs(i).size());
    l.out_channels = static_cast<int>(convolutions[i].live.size());
    return l;
  }
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
  std::vector<int> every_row;  // of predict()
  std::vector<float> predicted;
  Numbers narrow, transposed;  // one layer's weights or their gradient

  Impl(const NetworkShape& wanted, std::uint64_t seed, const Kernels& used) : kernels(used), shape(wanted) {
    for (const int channels : shape.channels) {
      if (channels != 1 && channels != 3)
        throw InputError(fmt::format("network: expected pictures of 1 or 3 channels, got {}", channels));
      Tower& tower = towers.emplace_back();
      for (const LayerKind kind : {channels == 1 ? mask_convolution : rgb_convolution, convolution2, convolution3}) {
        Convolution& c = tower.convolutions.emplace_back(kind);
        if (shape.batch_norm) c.norm.emplace(c.layer.out_channels);
      }
      if (channels == 1 && !shape.batch_norm) tower.front = std::make_unique<MaskFront>(kernels);
    }
    const std::vector<Range> ranges = lay_out();
    for (Numbers* array : {&parameters, &gradients, &mean, &variance}) *array = Numbers(count);
    int most_weights = 0;
    for (const Layer& layer : layers) most_weights = std::max(most_weights, layer.weights());
    for (Numbers* array : {&narrow, &transposed}) *array = Numbers(size(most_weights));
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
        const Layer& l = c.layer;
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
      text.weights = take(text.layer.weights());
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
    for (Tower& tower : towers) tower.head.weights = take(tower.head.layer.weights());
    if (shape.text) text_head_layer.weights = take(text_head_layer.layer.weights());
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
    for (Tower& tower : towers) {
      for (Convolution& c : tower.convolutions) {
        c.outputs = Numbers(size(rows * c.layer.outputs()));
        c.gradients = Numbers(size(rows * c.layer.outputs()));
      }
      if (tower.front) tower.front->make_room(rows);
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
    const bool sees_samples = i == towers[t].first();
    const int inputs = towers[t].live_layer(sees_samples ? 0 : i).inputs();
    for (int row = 0; row < rows; ++row)
      pictures[size(row)] = sees_samples ? samples.pictures[t].data() + size(batch[row]) * size(inputs)
                                         : towers[t].convolutions[i - 1].outputs + row * inputs;
  }

  // Of the pictures that are pointed at.
  void convolve(Tower& tower, std::size_t i, int rows, bool training) {
    Convolution& c = tower.convolutions[i];
    c.live = c.out;
    const Layer l = tower.live_layer(i);
    const float *weights = parameters + c.weights, *bias = parameters + c.bias;
    if (l.channels < c.layer.channels) {
      gather_weights(c.layer, weights, tower.inputs(i), narrow);
      weights = narrow;
    }
    if (i == 1 && tower.mostly_empty) {
      const Convolution& first = tower.convolutions[0];
      tower.front->forward(rows, parameters + first.weights, parameters + first.bias, weights, bias, c.outputs);
    } else {
      for (int row = 0; row < rows; ++row)
        kernels.forward(l, pictures[size(row)], weights, bias, c.outputs + row * l.outputs(), !c.norm);
    }
    if (c.norm) {
      if (training)
        c.norm->train(c.outputs, c.positions(rows), parameters + c.scale, parameters + c.shift);
      else
        c.norm->apply(c.outputs, c.positions(rows), parameters + c.scale, parameters + c.shift);
      for (int k = 0; k < rows * l.outputs(); ++k) c.outputs[k] = std::max(c.outputs[k], 0.f);
    } else if (training && i + 1 < tower.convolutions.size()) {
      float sums[most_channels];
      kernels.sum_rows(c.outputs, sums, c.positions(rows), l.out_channels);
      // A row of the next kernel is whole vectors.
      live_channels(sums, l.out_channels, 16 / std::gcd(16, tower.convolutions[i + 1].layer.kernel), c.live);
      if (c.live.size() < c.out.size()) pack(c.outputs, c.positions(rows), l.out_channels, c.live);
    }
  }

  // Leaves the batch's outputs, rows x padded_action.
  void forward(const Samples& samples, const int* batch, int rows, bool training) {
    make_room(rows);
    for (std::size_t t = 0; t < towers.size(); ++t) {
      Tower& tower = towers[t];
      tower.mostly_empty = false;
      if (tower.front) {
        point_at_inputs(t, 0, samples, batch, rows);
        tower.mostly_empty = tower.front->find(pictures, rows);
        tower.convolutions[0].live = tower.convolutions[0].out;
      }
      for (std::size_t i = tower.first(); i < tower.convolutions.size(); ++i) {
        point_at_inputs(t, i, samples, batch, rows);
        convolve(tower, i, rows, training);
      }
    }
    if (shape.text) {
      for (int row = 0; row < rows; ++row)
        std::copy_n(samples.text.data() + size(batch[row]) * text_size, text_size, text_inputs + row * text_size);
      kernels.forward(text.on(rows), text_inputs, parameters + text.weights, parameters + text.bias, text_outputs,
                      false);
    }
    for (int row = 0; row < rows; ++row)
      std::copy_n(parameters + head_bias, padded_action, outputs + row * padded_action);
    for (Tower& tower : towers) add_head(tower.head, tower.convolutions.back().outputs, rows);
    if (shape.text) add_head(text_head_layer, text_outputs, rows);
  }

  void add_head(const Trained& head, const float* features, int rows) {
    static const float no_bias[padded_action] = {};
    kernels.forward(head.on(rows), features, parameters + head.weights, no_bias, part, false);
    for (int i = 0; i < rows * padded_action; ++i) outputs[i] += part[i];
  }

  // Leaves every gradient, given that of the outputs.
  void backward(const Samples& samples, const int* batch, int rows) {
    kernels.sum_rows(output_gradients, gradients + head_bias, rows, padded_action);
    for (std::size_t t = 0; t < towers.size(); ++t) {
      Convolution& last = towers[t].convolutions.back();
      backward_head(towers[t].head, last.outputs, last.gradients, rows);
      for (std::size_t i = towers[t].convolutions.size(); i-- > towers[t].first();) {
        point_at_inputs(t, i, samples, batch, rows);
        backward_convolution(towers[t], i, rows);
      }
    }
    if (!shape.text) return;
    backward_head(text_head_layer, text_outputs, text_gradients, rows);
    kernels.sum_rows(text_gradients, gradients + text.bias, rows, padded_text_features);
    const float* const in = text_inputs;
    kernels.weight_gradient(text.on(rows), &in, text_gradients, gradients + text.weights, 1);
  }

  void backward_convolution(Tower& tower, std::size_t i, int rows) {
    Convolution& c = tower.convolutions[i];
    const Layer l = tower.live_layer(i);
    kernels.relu_gradient(c.outputs, c.gradients, size(rows * l.outputs()));
    if (c.norm)
      c.norm->backward(c.gradients, c.positions(rows), parameters + c.scale, gradients + c.scale, gradients + c.shift);
    float sums[most_channels];
    kernels.sum_rows(c.gradients, sums, c.positions(rows), l.out_channels);
    std::fill_n(gradients + c.bias, c.layer.out_channels, 0.f);
    for (int k = 0; k < l.out_channels; ++k) gradients[c.bias + size(c.live[size(k)])] = sums[k];
    if (i == 1 && tower.mostly_empty) {
      const Convolution& first = tower.convolutions[0];
      return tower.front->backward(parameters + c.weights, c.live, c.gradients, sums, gradients + first.weights,
                                   gradients + first.bias, gradients + c.weights);
    }
    if (i > 0) {
      transpose_weights(c.layer, parameters + c.weights, tower.inputs(i), c.live, transposed);
      float* const in = tower.convolutions[i - 1].gradients;
      std::fill_n(in, rows * l.inputs(), 0.f);
      for (int row = 0; row < rows; ++row)
        kernels.input_gradient(l, c.gradients + row * l.outputs(), transposed, in + row * l.inputs());
    }
    const bool whole = l.weights() == c.layer.weights();
    float* const weight_gradient = whole ? gradients + c.weights : narrow;
    kernels.weight_gradient(l, pictures.data(), c.gradients, weight_gradient, rows);
    if (!whole) scatter_weights(c.layer, narrow, tower.inputs(i), c.live, gradients + c.weights);
  }

  void backward_head(Trained& head, const float* features, float* feature_gradients, int rows) {
    kernels.weight_gradient(head.on(rows), &features, output_gradients, gradients + head.weights, 1);
    transpose_weights(head.layer, parameters + head.weights, head.in, head.out, transposed);
    std::fill_n(feature_gradients, rows * head.layer.channels, 0.f);
    kernels.input_gradient(head.on(rows), output_gradients, transposed, feature_gradients);
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

const std::vector<float>& Network::predict(const Samples& samples) {
  impl_->every_row.resize(size(samples.rows));
  std::iota(impl_->every_row.begin(), impl_->every_row.end(), 0);
  impl_->forward(samples, impl_->every_row.data(), samples.rows, false);
  impl_->predicted.clear();
  for (int row = 0; row < samples.rows; ++row) {
    const float* const begin = impl_->outputs + row * padded_action;
    impl_->predicted.insert(impl_->predicted.end(), begin, begin + action_size);
  }
  return impl_->predicted;
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
