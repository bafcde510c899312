#include <lgabench/learning/heat_map_network.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include <lgabench/learning/samples.hpp>

namespace lgabench {
namespace {

constexpr double unit_m = .1;  // of a centroid's coordinates, so that a score needs no large weights

std::vector<std::size_t> places_from(std::size_t first, int count) {
  std::vector<std::size_t> places(size(count));
  std::iota(places.begin(), places.end(), first);
  return places;
}

// In place. Sums are of double precision.
void softmax(std::vector<float>& values) {
  const double highest = *std::max_element(values.begin(), values.end());
  double sum = 0;
  float before = std::numeric_limits<float>::quiet_NaN(), power = 0;  // most values of a mask's map are the same
  for (float& value : values) {
    if (value != before) power = static_cast<float>(std::exp((before = value) - highest));
    value = power;
    sum += value;
  }
  for (float& value : values) value = static_cast<float>(value / sum);
}

double log_of(float probability) { return std::log(std::max(double{probability}, 1e-30)); }

}  // namespace

HeatMapNetwork::HeatMapNetwork(const Field& field, int planes, bool text, std::size_t groups, std::uint64_t seed,
                               const Kernels& kernels)
    : field_(field), kernels_(kernels), parameters_(seed), map_(cells), groups_(groups), centroids_(features) {
  add_convolution(padded, planes, 5);
  for (const int layers_before : {1, 2}) {
    const Layer& before = convolutions_[size(layers_before - 1)].layer;
    add_convolution({before.out_rows(), before.out_columns()}, features, 3);
  }
  const auto zeros = [&](int count) {
    const std::size_t first = parameters_.take(count);
    parameters_.uniform(places_from(first, count), 0, 0);
    return first;
  };
  if (text) text_ = zeros(text_size * features);
  heat_ = zeros(features);
  scores_ = zeros(static_cast<int>(groups) * 2 * features);
  score_biases_ = zeros(static_cast<int>(groups));
  parameters_.finish();
  first_bias_ = Numbers(features);
  rows_shown_.resize(size(padded.rows));
  scratch_ = Numbers(size(std::max(convolutions_[0].layer.weights(), convolutions_[1].layer.weights())));
}

void HeatMapNetwork::add_convolution(PictureSize of_input, int channels, int kernel) {
  const Layer layer{of_input.rows, of_input.columns, channels, kernel, 1, features};
  const double bound = std::sqrt(6. / (kernel * layer.segment()));
  Convolution& c = convolutions_.emplace_back(Convolution{
      layer, parameters_.take(layer.weights()), parameters_.take(features), Numbers(size(layer.outputs())),
      Numbers(size(layer.outputs())), Numbers(size(layer.weights())), Numbers(size(kernel * layer.segment())),
      Numbers(features), std::vector<Span>(size(layer.out_rows()))});
  parameters_.uniform(places_from(c.weights, layer.weights()), -bound, bound);
  parameters_.uniform(places_from(c.bias, features), 0, 0);
}

const std::vector<float>& HeatMapNetwork::map(const float* planes, const float* prior, const float* text) {
  planes_ = planes;
  embedding_ = text;
  std::copy_n(parameters_[convolutions_[0].bias], features, static_cast<float*>(first_bias_));
  for (int i = 0; text && i < text_size; ++i)
    for (int k = 0; k < features; ++k) first_bias_[k] += text[i] * parameters_[text_][i * features + k];
  find_seen();
  for (std::size_t i = 0; i < convolutions_.size(); ++i) convolve(i);
  const Convolution& last = convolutions_.back();
  const auto heat = [&](const float* feature, float of_prior) {
    return std::inner_product(feature, feature + features, parameters_[heat_], of_prior);
  };
  const float empty_prior = prior ? prior[0] : 0.f, empty_heat = heat(last.of_empty, empty_prior);
  const float* feature = last.outputs;
  for (int cell = 0; cell < cells; ++cell, feature += features) {
    const Span seen = last.seen[size(cell / grid.columns)];
    const float of_prior = prior ? prior[cell] : 0.f;
    const int column = cell % grid.columns;
    const bool empty = column < seen.begin || column >= seen.end;
    map_[size(cell)] = empty && of_prior == empty_prior ? empty_heat : heat(feature, of_prior);
  }
  softmax(map_);
  return map_;
}

std::vector<float> HeatMapNetwork::highest_and_mean() const {
  std::vector<float> all(size(2 * features));
  const float* feature = convolutions_.back().outputs;  // none is below 0
  for (int cell = 0; cell < cells; ++cell)
    for (int k = 0; k < features; ++k, ++feature) {
      all[size(k)] = std::max(all[size(k)], *feature);
      all[size(features + k)] += *feature / cells;
    }
  return all;
}

// The columns of each row whose patch is not all 0: what one span of a row holds.
void HeatMapNetwork::find_seen() {
  const Layer& first = convolutions_[0].layer;
  const int line = first.columns * first.channels;
  for (int y = 0; y < first.rows; ++y) {
    const float* const begin = planes_ + y * line;
    const auto shows = [](float value) { return value != 0; };
    const int left = static_cast<int>(std::find_if(begin, begin + line, shows) - begin);
    int right = line;
    while (right > left && !shows(begin[right - 1])) --right;
    rows_shown_[size(y)] = {left / first.channels, (right + first.channels - 1) / first.channels};
  }
  const std::vector<Span>* rows = &rows_shown_;
  for (Convolution& c : convolutions_) {
    const int columns = c.layer.out_columns();
    for (int y = 0; y < c.layer.out_rows(); ++y) {
      Span all{columns, 0};
      for (int k = 0; k < c.layer.kernel; ++k) {
        const auto [begin, end] = (*rows)[size(y + k)];
        if (begin < end) all = {std::min(all.begin, begin - c.layer.kernel + 1), std::max(all.end, end)};
      }
      c.seen[size(y)] = all.begin < all.end ? Span{std::max(all.begin, 0), std::min(all.end, columns)} : Span{0, 0};
    }
    rows = &c.seen;
  }
}

// What a patch of nothing gives is computed once, and copied.
void HeatMapNetwork::convolve(std::size_t i) {
  Convolution& c = convolutions_[i];
  const Layer& l = c.layer;
  const float* const bias = i == 0 ? first_bias_ : parameters_[c.bias];
  if (i > 0)
    for (int k = 0; k < l.kernel * l.kernel; ++k)
      std::copy_n(static_cast<const float*>(convolutions_[i - 1].of_empty), features, c.empty_patch + k * features);
  kernels_.forward({l.kernel, l.kernel, l.channels, l.kernel, 1, features}, c.empty_patch, parameters_[c.weights], bias,
                   c.of_empty, true, nullptr);
  kernels_.forward(l, input(i), parameters_[c.weights], bias, c.outputs, true, c.seen.data());
  float* to = c.outputs;
  const float* const empty = c.of_empty;
  const auto fill = [&](int count) {
    for (int column = 0; column < count; ++column, to += features)
      std::memcpy(to, empty, features * sizeof(float));  // a constant size, which a compiler makes two instructions of
  };
  for (const auto [begin, end] : c.seen) {
    fill(begin);
    to += (end - begin) * features;
    fill(l.out_columns() - end);
  }
}

const std::vector<float>& HeatMapNetwork::groups(Vec2 taken_m) {
  std::fill(centroids_.begin(), centroids_.end(), Centroid{0, 0, 1e-6});
  const float* feature = convolutions_.back().outputs;
  for (int cell = 0; cell < cells; ++cell) {
    const Vec2 away = 1 / unit_m * (middle_of_cell(cell) - taken_m);
    for (Centroid& c : centroids_) {
      c.x += *feature * away.x;
      c.y += *feature * away.y;
      c.mass += *feature++;
    }
  }
  for (Centroid& c : centroids_) {
    c.x /= c.mass;
    c.y /= c.mass;
  }
  const float* weight = parameters_[scores_];
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    double score = parameters_[score_biases_][g];
    for (const Centroid& c : centroids_) {
      score += *weight++ * c.x;
      score += *weight++ * c.y;
    }
    groups_[g] = static_cast<float>(score);
  }
  softmax(groups_);
  return groups_;
}

void HeatMapNetwork::clear_gradients() {
  parameters_.clear_gradients();
  for (std::size_t i = 1; i < convolutions_.size(); ++i) {
    Convolution& c = convolutions_[i];
    transpose_weights(c.layer, parameters_[c.weights], c.transposed);
  }
}

double HeatMapNetwork::teach(const std::vector<float>& wanted, Vec2 taken_m, std::size_t group, double weight,
                             const std::vector<float>& like, double penalty) {
  double loss = 0;
  Convolution& last = convolutions_.back();
  const float* feature = last.outputs;
  float *const of_heats = parameters_.gradient(heat_), *gradient = last.gradients;
  float heat[features], of_weights[features];  // where nothing else can point to, so that the loops are vectors
  std::copy_n(parameters_[heat_], features, heat);
  std::copy_n(of_heats, features, of_weights);
  for (std::size_t cell = 0; cell < map_.size(); ++cell, feature += features, gradient += features) {
    if (wanted[cell] > 0) loss -= wanted[cell] * log_of(map_[cell]);
    double away = map_[cell] - wanted[cell];
    if (!like.empty()) {
      loss -= penalty * like[cell] * log_of(map_[cell]);
      away += penalty * (map_[cell] - like[cell]);
    }
    const auto of_heat = static_cast<float>(weight * away);
    for (int k = 0; k < features; ++k) of_weights[k] += of_heat * feature[k];
    for (int k = 0; k < features; ++k) gradient[k] = of_heat * heat[k];
  }
  std::copy_n(of_weights, features, of_heats);
  if (groups_.size() > 1) loss += teach_groups(taken_m, group, weight);
  backward();
  return loss;
}

// Adds to the gradients of the features.
double HeatMapNetwork::teach_groups(Vec2 taken_m, std::size_t group, double weight) {
  groups(taken_m);
  std::vector<Centroid> gradients(features, Centroid{0, 0, 0});
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const double of_score = weight * (groups_[g] - (g == group ? 1.f : 0.f));
    parameters_.gradient(score_biases_)[g] += static_cast<float>(of_score);
    for (std::size_t k = 0; k < features; ++k) {
      const std::size_t at = 2 * (g * features + k);
      parameters_.gradient(scores_)[at] += static_cast<float>(of_score * centroids_[k].x);
      parameters_.gradient(scores_)[at + 1] += static_cast<float>(of_score * centroids_[k].y);
      gradients[k].x += of_score * parameters_[scores_][at];
      gradients[k].y += of_score * parameters_[scores_][at + 1];
    }
  }
  float* gradient = convolutions_.back().gradients;
  for (int cell = 0; cell < cells; ++cell) {
    const Vec2 away = 1 / unit_m * (middle_of_cell(cell) - taken_m);
    for (std::size_t k = 0; k < features; ++k)
      *gradient++ += static_cast<float>(
          (gradients[k].x * (away.x - centroids_[k].x) + gradients[k].y * (away.y - centroids_[k].y)) /
          centroids_[k].mass);
  }
  return -log_of(groups_[group]);
}

void HeatMapNetwork::backward() {
  for (std::size_t i = convolutions_.size(); i-- > 0;) {
    Convolution& c = convolutions_[i];
    kernels_.relu_gradient(c.outputs, c.gradients, size(c.layer.outputs()));
    const float* const in = input(i);
    // A product with 0 adds nothing.
    kernels_.weight_gradient(c.layer, &in, c.gradients, scratch_, 1, i == 0 ? c.seen.data() : nullptr);
    float* const weights = parameters_.gradient(c.weights);
    for (int k = 0; k < c.layer.weights(); ++k) weights[k] += scratch_[k];
    kernels_.sum_rows(c.gradients, scratch_, c.layer.out_rows() * c.layer.out_columns(), features);
    float* const bias = parameters_.gradient(c.bias);
    for (int k = 0; k < features; ++k) bias[k] += scratch_[k];
    if (i > 0) {
      Convolution& before = convolutions_[i - 1];
      std::fill_n(static_cast<float*>(before.gradients), before.layer.outputs(), 0.f);
      // Where the picture is empty, all outputs are alike: what ReLU closes there lets no gradient through.
      int channels[features], count = 0;
      for (int k = 0; k < features; ++k)
        if (c.of_empty[k] > 0) channels[count++] = k;
      const OpenChannels open{c.seen.data(), channels, count};
      kernels_.input_gradient(c.layer, c.gradients, c.transposed, before.gradients, &open);
    } else if (embedding_) {
      float* const text = parameters_.gradient(text_);
      for (int e = 0; e < text_size; ++e)
        for (int k = 0; k < features; ++k) text[e * features + k] += embedding_[e] * scratch_[k];
    }
  }
}

}  // namespace lgabench
