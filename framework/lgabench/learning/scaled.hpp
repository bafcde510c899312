// Trains on an action's numbers as shares of their bounds. Private to learning/.
#pragma once
#include <memory>

#include <lgabench/learning/learner.hpp>

namespace lgabench {

/// A learner whose labels and outputs are scaled so that each number's bounds become -1 and 1: numbers of different
/// units then weigh alike in its loss.
class ScaledLearner : public Learner {
 public:
  /// @pre `inner` is not null; `actions` are what its labels are.
  ScaledLearner(std::unique_ptr<Learner> inner, ActionSpace actions)
      : inner_(std::move(inner)), actions_(std::move(actions)) {}

  TrainingOptions schedule(const TrainingOptions& asked, int samples) const override {
    return inner_->schedule(asked, samples);
  }
  /// Keeps a copy of the samples.
  void begin(const Samples& samples) override;
  const std::vector<float>& predict(const Samples& samples) override;
  std::vector<float> features(const Samples& samples) override { return inner_->features(samples); }
  double backward(const Samples&, const std::vector<int>& batch) override { return inner_->backward(*scaled_, batch); }
  void update(double learning_rate) override { inner_->update(learning_rate); }
  std::vector<float> parameters() const override { return inner_->parameters(); }
  bool learned(Archive& archive) override { return inner_->learned(archive); }

 private:
  std::unique_ptr<Learner> inner_;
  ActionSpace actions_;
  std::unique_ptr<Samples> scaled_;
  std::vector<float> outputs_;
};

}  // namespace lgabench
