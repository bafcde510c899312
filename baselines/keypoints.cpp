// The abstraction in the input, as geometry: of what is kept to be taken and to be avoided the centroid, the principal
// axis and the extent along it and across, and a small network from these numbers to the action. After KALM (arXiv
// 2410.23254) and the study of inputs by KIL (2605.26649): moments of a mask in place of tracked or learned points.
#include <algorithm>
#include <array>
#include <cmath>

#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

using namespace lgabench;

namespace {

constexpr std::size_t features = 12, hidden = 64;
constexpr int steps = 2000, batch_size = 16;
constexpr double learning_rate = 3e-3;
using Features = std::array<double, features>;

// Of the pixels with that sign; coordinates from -1 to 1, all 0 where there is none.
void write_moments(const float* mask, PictureSize size, float sign, double* to) {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (int row = 0; row < size.rows; ++row)
    for (int column = 0; column < size.columns; ++column) {
      if (mask[row * size.columns + column] * sign <= 0) continue;
      const double down = 2 * (row + .5) / size.rows - 1, across = 2 * (column + .5) / size.columns - 1;
      n += 1, x += down, y += across, xx += down * down, yy += across * across, xy += down * across;
    }
  if (n == 0) return;
  x /= n, y /= n;
  const double cxx = xx / n - x * x, cyy = yy / n - y * y, cxy = xy / n - x * y;
  const double spread = std::hypot(cxx - cyy, 2 * cxy), longest = (cxx + cyy + spread) / 2;
  to[0] = x, to[1] = y;
  to[2] = spread > 0 ? (cxx - cyy) / spread : 0, to[3] = spread > 0 ? 2 * cxy / spread : 0;  // twice its angle
  to[4] = std::sqrt(longest), to[5] = std::sqrt(std::max(0., cxx + cyy - longest));
}

// One hidden layer beside a linear one; actions scaled to their bounds, squared error, Adam.
class Points : public Learner {
 public:
  Points(const SampleShape& shape, std::uint64_t seed)
      : shape_(shape), outs_(shape.actions.size()), values_(hidden * (features + 1) + outs_ * (hidden + features + 1)) {
    RandomStream random("keypoints/" + std::to_string(seed));
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const double bound = 1 / std::sqrt(static_cast<double>(i < first_bias() ? features : hidden));
      values_[i] = random.uniform(-bound, bound);
    }
    for (auto* all : {&gradients_, &mean_, &variance_}) all->resize(values_.size());
  }

  TrainingOptions schedule(const TrainingOptions&, int samples) const override {
    const int batches = samples / std::min(batch_size, samples);
    return {(steps + batches - 1) / batches, batch_size, learning_rate, Batches::shuffled, true};
  }
  void begin(const Samples& samples) override {
    for (int row = 0; row < samples.rows; ++row) shown_.push_back(features_of(samples, row));
  }
  const std::vector<float>& predict(const Samples& samples) override {
    outputs_.clear();
    for (int row = 0; row < samples.rows; ++row) {
      const std::vector<double> scaled = forward(features_of(samples, row));
      for (std::size_t k = 0; k < outs_; ++k) {
        const ActionNumber& number = shape_.actions.numbers[k];
        outputs_.push_back(static_cast<float>((number.low + number.high + scaled[k] * (number.high - number.low)) / 2));
      }
    }
    return outputs_;
  }
  double backward(const Samples& samples, const std::vector<int>& batch) override {
    std::fill(gradients_.begin(), gradients_.end(), 0);
    double loss = 0;
    for (const int row : batch) {
      const Features& in = shown_[static_cast<std::size_t>(row)];
      const std::vector<double> out = forward(in);
      const Action label = samples.label(row);
      std::array<double, hidden> of_hidden{};
      for (std::size_t k = 0; k < outs_; ++k) {
        const ActionNumber& number = shape_.actions.numbers[k];
        const double wanted = (2 * label[k] - number.low - number.high) / (number.high - number.low);
        loss += (out[k] - wanted) * (out[k] - wanted) / static_cast<double>(batch.size());
        const double gradient = 2 * (out[k] - wanted) / static_cast<double>(batch.size());
        const std::size_t at = row_of(k);
        for (std::size_t h = 0; h < hidden; ++h) {
          gradients_[at + h] += gradient * hidden_[h];
          of_hidden[h] += gradient * values_[at + h];
        }
        for (std::size_t i = 0; i < features; ++i) gradients_[at + hidden + i] += gradient * in[i];
        gradients_[at + hidden + features] += gradient;
      }
      for (std::size_t h = 0; h < hidden; ++h) {
        if (hidden_[h] <= 0) continue;
        for (std::size_t i = 0; i < features; ++i) gradients_[h * features + i] += of_hidden[h] * in[i];
        gradients_[first_bias() + h] += of_hidden[h];
      }
    }
    return loss;
  }
  void update(double rate) override {
    ++updates_;
    const double mean_part = 1 - std::pow(.9, updates_), variance_part = 1 - std::pow(.999, updates_);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      mean_[i] = .9 * mean_[i] + .1 * gradients_[i];
      variance_[i] = .999 * variance_[i] + .001 * gradients_[i] * gradients_[i];
      values_[i] -= rate * mean_[i] / mean_part / (std::sqrt(variance_[i] / variance_part) + 1e-8);
    }
  }
  std::vector<float> parameters() const override { return {values_.begin(), values_.end()}; }
  bool learned(Archive& archive) override {
    const std::size_t known = values_.size();
    archive(values_);
    if (values_.size() != known) Archive::fail();
    return true;
  }

 private:
  static constexpr std::size_t first_bias() { return hidden * features; }
  // Of the weights of an output: those of the hidden layer, of the features, and its bias.
  static std::size_t row_of(std::size_t out) { return hidden * (features + 1) + out * (hidden + features + 1); }

  Features features_of(const Samples& samples, int row) const {
    Features all{};
    for (const bool avoided : {false, true})
      write_moments(samples.picture(0, row), shape_.pictures[0].size, avoided ? -1.f : 1.f,
                    all.data() + (avoided ? features / 2 : 0));
    return all;
  }
  std::vector<double> forward(const Features& in) {
    for (std::size_t h = 0; h < hidden; ++h) {
      double sum = values_[first_bias() + h];
      for (std::size_t i = 0; i < features; ++i) sum += values_[h * features + i] * in[i];
      hidden_[h] = std::max(0., sum);
    }
    std::vector<double> out(outs_);
    for (std::size_t k = 0; k < outs_; ++k) {
      const std::size_t at = row_of(k);
      out[k] = values_[at + hidden + features];
      for (std::size_t h = 0; h < hidden; ++h) out[k] += values_[at + h] * hidden_[h];
      for (std::size_t i = 0; i < features; ++i) out[k] += values_[at + hidden + i] * in[i];
    }
    return out;
  }

  SampleShape shape_;
  std::size_t outs_;
  std::vector<double> values_, gradients_, mean_, variance_;
  std::vector<Features> shown_;  // of each row that is learned from
  std::array<double, hidden> hidden_{};
  std::vector<float> outputs_;
  int updates_ = 0;
};

}  // namespace

class Keypoints : public CloningMethod {
 public:
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    return select_as_asked(command, space, services);
  }

 protected:
  PolicyInputs inputs(const Json&) const override {
    PolicyInputs inputs{{PolicyInputs::Picture::mask}};
    inputs.signed_mask = true;
    return inputs;
  }
  std::unique_ptr<Learner> learner(const SampleShape& shape, const Services& services) const override {
    return std::make_unique<Points>(shape, services.seed);
  }
};

LGABENCH_METHOD("keypoints", "0.1", "A small network on centroid, axis and extent of what a language model selected",
                Keypoints, "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_TRAINING_OPTIONS "}")
