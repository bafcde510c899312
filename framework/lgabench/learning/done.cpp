#include <lgabench/learning/done.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace lgabench {
namespace {

using Row = std::vector<float>;
using Sum = std::vector<double>;

std::optional<std::size_t> first_mask(const SampleShape& shape) {
  for (std::size_t i = 0; i < shape.pictures.size(); ++i)
    if (shape.pictures[i].channels == 1) return i;
  return std::nullopt;
}

bool shows_target(const Samples& samples, std::size_t mask, int row) {
  const float* const first = samples.picture(mask, row);
  return std::any_of(first, first + samples.shape.pictures[mask].numbers(), [](float value) { return value > 0; });
}

bool mostly_empty(const Samples& samples, std::size_t mask) {
  int empty = 0;
  for (int row = 0; row < samples.rows; ++row) empty += shows_target(samples, mask, row) ? 0 : 1;
  return 2 * empty > samples.rows;
}

std::vector<Row> features_of(Learner& learner, const Samples& samples) {
  const std::vector<float> numbers = learner.features(samples);
  const std::size_t each = numbers.size() / static_cast<std::size_t>(samples.rows);
  std::vector<Row> rows;
  for (auto at = numbers.begin(); at != numbers.end(); at += static_cast<std::ptrdiff_t>(each))
    rows.emplace_back(at, at + static_cast<std::ptrdiff_t>(each));
  return rows;
}

// A row's features as they deviate from their means, in standard deviations, and a constant.
struct Standard {
  Sum mean, scale;  // a scale of 0 leaves out what never differs

  explicit Standard(const std::vector<Row>& rows) : mean(rows.front().size()), scale(mean.size()) {
    const auto n = static_cast<double>(rows.size());
    for (const Row& row : rows)
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += double{row[i]} / n;
    for (const Row& row : rows)
      for (std::size_t i = 0; i < mean.size(); ++i) scale[i] += (row[i] - mean[i]) * (row[i] - mean[i]) / n;
    for (double& one : scale) one = one > 1e-12 ? 1 / std::sqrt(one) : 0;
  }

  Sum of(const Row& row) const {
    Sum numbers;
    for (std::size_t i = 0; i < mean.size(); ++i) numbers.push_back((row[i] - mean[i]) * scale[i]);
    numbers.push_back(1);
    return numbers;
  }
};

double product(const Sum& a, const Sum& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

struct Example {
  Sum features;
  double done, weight;  // weights of all are 1 together
};

// The gradient of the mean logistic loss and of half the squared weights, without the constant's, over the rows.
Sum gradient_at(const Sum& weights, const std::vector<Example>& examples) {
  Sum gradient = weights;
  for (double& one : gradient) one /= static_cast<double>(examples.size());
  gradient.back() = 0;
  for (const Example& one : examples) {
    const double error = one.weight * (1 / (1 + std::exp(-product(weights, one.features))) - one.done);
    for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] += error * one.features[i];
  }
  return gradient;
}

// Nesterov's accelerated descent, whose step no curvature of the loss exceeds.
Sum least(const std::vector<Example>& examples) {
  constexpr int steps = 1000;
  double curvature = 1 / static_cast<double>(examples.size());
  for (const Example& one : examples) curvature += one.weight * product(one.features, one.features) / 4;
  Sum weights(examples.front().features.size()), before = weights, ahead = weights;
  for (int step = 1; step <= steps; ++step) {
    const Sum gradient = gradient_at(ahead, examples);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      before[i] = weights[i];
      weights[i] = ahead[i] - gradient[i] / curvature;
      ahead[i] = weights[i] + (step - 1.) / (step + 2.) * (weights[i] - before[i]);
    }
  }
  return weights;
}

}  // namespace

Done::Done(Learner& learner, const Samples& acting, const Samples& done) {
  if (done.rows == 0) return;
  const std::optional<std::size_t> mask = first_mask(done.shape);
  if (mask && mostly_empty(done, *mask)) {
    how_ = How::empty_mask;
    return;
  }
  const std::vector<Row> said = features_of(learner, done);
  if (said.empty()) return;
  std::vector<Row> all = features_of(learner, acting);
  const std::size_t of_acting = all.size();
  all.insert(all.end(), said.begin(), said.end());
  const Standard standard(all);
  std::vector<Example> examples;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_done = i >= of_acting;
    examples.push_back(
        {standard.of(all[i]), is_done ? 1. : 0., .5 / static_cast<double>(is_done ? said.size() : of_acting)});
  }
  weights_ = least(examples);
  for (std::size_t i = 0; i < standard.mean.size(); ++i) {  // so that they weigh features as they are
    weights_[i] *= standard.scale[i];
    weights_.back() -= weights_[i] * standard.mean[i];
  }
  how_ = How::logistic;
}

bool Done::is_said(Learner& learner, const Samples& row) const {
  switch (how_) {
    case How::never:
      break;
    case How::empty_mask: {
      const std::optional<std::size_t> mask = first_mask(row.shape);
      if (!mask) Archive::fail();  // restored of another shape, as below
      return !shows_target(row, *mask, 0);
    }
    case How::logistic: {
      const Row features = learner.features(row);
      Sum numbers(features.begin(), features.end());
      numbers.push_back(1);
      if (numbers.size() != weights_.size()) Archive::fail();
      return product(weights_, numbers) > 0;
    }
  }
  return false;
}

void Done::learned(Archive& archive) {
  auto how = static_cast<std::uint8_t>(how_);
  archive(how);
  if (how > static_cast<std::uint8_t>(How::logistic)) Archive::fail();
  how_ = static_cast<How>(how);
  archive(weights_);
  for (const double weight : weights_)
    if (!std::isfinite(weight)) Archive::fail();
}

}  // namespace lgabench
