// A method that is not of this framework: its option `loss` has the name of one of CloningMethod's, and other values.
#include <lgabench/learning/cloning_method.hpp>

#include "../fixture.hpp"

namespace {

using namespace lgabench;

// The mean of the demonstrated actions, whatever it sees.
class Mean : public Learner {
 public:
  explicit Mean(std::size_t numbers) : mean_(numbers) {}
  void begin(const Samples& samples) override {
    for (std::size_t i = 0; i < samples.labels.size(); ++i)
      mean_[i % mean_.size()] += samples.labels[i] / static_cast<float>(samples.rows);
  }
  const std::vector<float>& predict(const Samples& samples) override {
    predicted_.clear();
    for (int row = 0; row < samples.rows; ++row) predicted_.insert(predicted_.end(), mean_.begin(), mean_.end());
    return predicted_;
  }
  double backward(const Samples&, const std::vector<int>&) override { return 0; }
  void update(double) override {}
  std::vector<float> parameters() const override { return mean_; }

 private:
  std::vector<float> mean_, predicted_;
};

class OwnLoss : public CloningMethod {
 public:
  Needs needs(const Json&) const override { return {Needs::Targets::truth}; }
  Selection select(const Command&, const FeatureSpace&, Services&) override { return {}; }

 protected:
  PolicyInputs inputs(const Json&) const override { return {{PolicyInputs::Picture::rgb}}; }
  std::unique_ptr<Learner> learner(const SampleShape& shape, const Services& services) const override {
    if (services.options.at("loss") != "huber") throw MethodError("loss: expected huber");
    return std::make_unique<Mean>(shape.actions.size());
  }
};

}  // namespace

LGABENCH_METHOD("fixture_own_loss", "0.1", "has a loss of its own", OwnLoss, "{" LGABENCH_TRAINING_OPTIONS R"(,
  "loss": {"default": "huber", "values": ["huber"], "help": "its own", "source": "test fixture"}})")
