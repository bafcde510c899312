// A small network of numbers to numbers, and its gradients: one hidden layer beside a linear one.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include <lgabench/core/random.hpp>

class Perceptron {
 public:
  static constexpr std::size_t hidden = 64;

  Perceptron(std::size_t ins, std::size_t outs, lgabench::RandomStream random)
      : ins_(ins), outs_(outs), values_(hidden * (ins + 1) + outs * (hidden + ins + 1)), hidden_(hidden) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const double bound = 1 / std::sqrt(static_cast<double>(i < first_bias() ? ins_ : hidden));
      values_[i] = random.uniform(-bound, bound);
    }
    for (auto* all : {&gradients_, &mean_, &variance_}) all->resize(values_.size());
  }

  std::vector<double> forward(const std::vector<double>& in) {
    for (std::size_t h = 0; h < hidden; ++h) {
      double sum = values_[first_bias() + h];
      for (std::size_t i = 0; i < ins_; ++i) sum += values_[h * ins_ + i] * in[i];
      hidden_[h] = std::max(0., sum);
    }
    std::vector<double> out(outs_);
    for (std::size_t k = 0; k < outs_; ++k) {
      const std::size_t at = row_of(k);
      out[k] = values_[at + hidden + ins_];
      for (std::size_t h = 0; h < hidden; ++h) out[k] += values_[at + h] * hidden_[h];
      for (std::size_t i = 0; i < ins_; ++i) out[k] += values_[at + hidden + i] * in[i];
    }
    return out;
  }
  // Adds the gradients of a loss whose gradient by the outputs of the last forward(), of the same `in`, is that one.
  // Its gradient by `in`.
  std::vector<double> backward(const std::vector<double>& in, const std::vector<double>& by_out) {
    std::vector<double> by_hidden(hidden), by_in(ins_);
    for (std::size_t k = 0; k < outs_; ++k) {
      const std::size_t at = row_of(k);
      for (std::size_t h = 0; h < hidden; ++h) {
        gradients_[at + h] += by_out[k] * hidden_[h];
        by_hidden[h] += by_out[k] * values_[at + h];
      }
      for (std::size_t i = 0; i < ins_; ++i) {
        gradients_[at + hidden + i] += by_out[k] * in[i];
        by_in[i] += by_out[k] * values_[at + hidden + i];
      }
      gradients_[at + hidden + ins_] += by_out[k];
    }
    for (std::size_t h = 0; h < hidden; ++h) {
      if (hidden_[h] <= 0) continue;
      for (std::size_t i = 0; i < ins_; ++i) {
        gradients_[h * ins_ + i] += by_hidden[h] * in[i];
        by_in[i] += by_hidden[h] * values_[h * ins_ + i];
      }
      gradients_[first_bias() + h] += by_hidden[h];
    }
    return by_in;
  }
  // One step of Adam; the gradients are 0 again.
  void update(double rate) {
    ++updates_;
    const double mean_part = 1 - std::pow(.9, updates_), variance_part = 1 - std::pow(.999, updates_);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      mean_[i] = .9 * mean_[i] + .1 * gradients_[i];
      variance_[i] = .999 * variance_[i] + .001 * gradients_[i] * gradients_[i];
      values_[i] -= rate * mean_[i] / mean_part / (std::sqrt(variance_[i] / variance_part) + 1e-8);
    }
    std::fill(gradients_.begin(), gradients_.end(), 0);
  }
  // As many as ever, in an order that does not change.
  std::vector<double>& values() { return values_; }
  const std::vector<double>& values() const { return values_; }

 private:
  std::size_t first_bias() const { return hidden * ins_; }
  // Of the weights of an output: those of the hidden layer, of the inputs, and its bias.
  std::size_t row_of(std::size_t out) const { return hidden * (ins_ + 1) + out * (hidden + ins_ + 1); }

  std::size_t ins_, outs_;
  std::vector<double> values_, gradients_, mean_, variance_, hidden_;
  int updates_ = 0;
};
