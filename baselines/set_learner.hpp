// A small network on vectors in place of pictures: one for each thing that a row's pictures show.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <lgabench/core/random.hpp>
#include <lgabench/learning/learner.hpp>

#include "perceptron.hpp"

// Of pixels that are counted one by one: the middle, the principal axis and the extent along it and across. Coordinates
// from -1 to 1; all 0 where none was counted.
class Moments {
 public:
  static constexpr std::size_t numbers = 6;

  void add(int row, int column, lgabench::PictureSize size) {
    const double down = 2 * (row + .5) / size.rows - 1, across = 2 * (column + .5) / size.columns - 1;
    n_ += 1;
    x_ += down;
    y_ += across;
    xx_ += down * down;
    yy_ += across * across;
    xy_ += down * across;
  }
  double counted() const { return n_; }
  std::array<double, numbers> result() const {
    if (n_ == 0) return {};
    const double x = x_ / n_, y = y_ / n_;
    const double cxx = xx_ / n_ - x * x, cyy = yy_ / n_ - y * y, cxy = xy_ / n_ - x * y;
    const double spread = std::hypot(cxx - cyy, 2 * cxy), longest = (cxx + cyy + spread) / 2;
    return {x,
            y,
            spread > 0 ? (cxx - cyy) / spread : 0,  // twice the axis's angle
            spread > 0 ? 2 * cxy / spread : 0,
            std::sqrt(longest),
            std::sqrt(std::max(0., cxx + cyy - longest))};
  }

 private:
  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, yy_ = 0, xy_ = 0;
};

// Each thing of a set proposes an action by where it lies, and what it is says how much that counts: attention over
// object proposals (Devin et al., ICRA 2018, arXiv 1708.04225). Actions scaled to their bounds, squared error, Adam.
class SetLearner : public lgabench::Learner {
 public:
  struct Thing {
    std::vector<double> what, where;
  };
  using Set = std::vector<Thing>;  // not empty

  // `what`, `where`: numbers of each. `name` and seed say how it begins.
  SetLearner(const lgabench::ActionSpace& actions, std::size_t what, std::size_t where, const std::string& name,
             std::uint64_t seed)
      : actions_(actions),
        propose_(where, actions.size(), lgabench::RandomStream(name + "/" + std::to_string(seed))),
        weigh_(what, 1, lgabench::RandomStream(name + "/weigh/" + std::to_string(seed))) {}

  lgabench::TrainingOptions schedule(const lgabench::TrainingOptions&, int samples) const override {
    constexpr int steps = 2000, batch_size = 16;
    const int batches = samples / std::min(batch_size, samples);
    return {(steps + batches - 1) / batches, batch_size, 3e-3, lgabench::Batches::shuffled, true};
  }
  void begin(const lgabench::Samples& samples) override {
    for (int row = 0; row < samples.rows; ++row) shown_.push_back(set_of(samples, row));
  }
  // What the weightiest proposes.
  const std::vector<float>& predict(const lgabench::Samples& samples) override {
    outputs_.clear();
    for (int row = 0; row < samples.rows; ++row) {
      const Set set = set_of(samples, row);
      const std::vector<double> weights = weights_of(set);
      const auto most = std::max_element(weights.begin(), weights.end()) - weights.begin();
      const std::vector<double> scaled = propose_.forward(set[static_cast<std::size_t>(most)].where);
      for (std::size_t k = 0; k < scaled.size(); ++k) {
        const auto& [name, unit, low, high] = actions_.numbers[k];
        outputs_.push_back(static_cast<float>((low + high + scaled[k] * (high - low)) / 2));
      }
    }
    return outputs_;
  }
  // Of all proposals the error, weighted.
  double backward(const lgabench::Samples& samples, const std::vector<int>& batch) override {
    const auto rows = static_cast<double>(batch.size());
    double loss = 0;
    for (const int row : batch) {
      const Set& set = shown_[static_cast<std::size_t>(row)];
      const lgabench::Action label = samples.label(row);
      const std::vector<double> weights = weights_of(set);
      std::vector<double> errors(set.size());
      double error = 0;
      for (std::size_t i = 0; i < set.size(); ++i) {
        std::vector<double> by_out = propose_.forward(set[i].where);
        for (std::size_t k = 0; k < by_out.size(); ++k) {
          const auto& [name, unit, low, high] = actions_.numbers[k];
          const double off = by_out[k] - (2 * label[k] - low - high) / (high - low);
          errors[i] += off * off / rows;
          by_out[k] = weights[i] * (2 * off / rows);
        }
        propose_.backward(set[i].where, by_out);
        error += weights[i] * errors[i];
      }
      for (std::size_t i = 0; set.size() > 1 && i < set.size(); ++i) {
        weigh_.forward(set[i].what);
        weigh_.backward(set[i].what, {weights[i] * (errors[i] - error)});
      }
      loss += error;
    }
    return loss;
  }
  void update(double rate) override {
    for (Perceptron* part : {&propose_, &weigh_}) part->update(rate);
  }
  std::vector<float> parameters() const override {
    std::vector<float> all(propose_.values().begin(), propose_.values().end());
    all.insert(all.end(), weigh_.values().begin(), weigh_.values().end());
    return all;
  }
  bool learned(lgabench::Archive& archive) override {
    for (Perceptron* part : {&propose_, &weigh_}) {
      const std::size_t known = part->values().size();
      archive(part->values());
      if (part->values().size() != known) lgabench::Archive::fail();
    }
    return true;
  }

 protected:
  virtual Set set_of(const lgabench::Samples& samples, int row) const = 0;

 private:
  // A softmax of their scores.
  std::vector<double> weights_of(const Set& set) {
    std::vector<double> weights;
    for (const Thing& thing : set) weights.push_back(weigh_.forward(thing.what)[0]);
    const double most = *std::max_element(weights.begin(), weights.end());
    double sum = 0;
    for (double& weight : weights) sum += weight = std::exp(weight - most);
    for (double& weight : weights) weight /= sum;
    return weights;
  }

  lgabench::ActionSpace actions_;
  Perceptron propose_, weigh_;
  std::vector<Set> shown_;  // of each row that is learned from
  std::vector<float> outputs_;
};
