#include <lgabench/learning/scaled.hpp>

namespace lgabench {
namespace {

double middle(const ActionNumber& n) { return (n.low + n.high) / 2; }
double half_range(const ActionNumber& n) { return (n.high - n.low) / 2; }

}  // namespace

void ScaledLearner::begin(const Samples& samples) {
  scaled_ = std::make_unique<Samples>(samples);
  for (std::size_t i = 0; i < scaled_->labels.size(); ++i) {
    const ActionNumber& number = actions_.numbers[i % actions_.size()];
    scaled_->labels[i] = static_cast<float>((scaled_->labels[i] - middle(number)) / half_range(number));
  }
  inner_->begin(*scaled_);
}

const std::vector<float>& ScaledLearner::predict(const Samples& samples) {
  outputs_ = inner_->predict(samples);
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const ActionNumber& number = actions_.numbers[i % actions_.size()];
    outputs_[i] = static_cast<float>(middle(number) + half_range(number) * outputs_[i]);
  }
  return outputs_;
}

}  // namespace lgabench
