// The abstraction in the input, as geometry: of what is kept to be taken and to be avoided the centroid, the principal
// axis and the extent along it and across, and a small network from these numbers to the action. After KALM (arXiv
// 2410.23254) and the study of inputs by KIL (2605.26649): moments of a mask in place of tracked or learned points.
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

#include "set_learner.hpp"

using namespace lgabench;

namespace {

class Points : public SetLearner {
 public:
  Points(const SampleShape& shape, std::uint64_t seed)
      : SetLearner(shape.actions, 0, 2 * Moments::numbers, "keypoints", seed), size_(shape.pictures[0].size) {}

 protected:
  Set set_of(const Samples& samples, int row) const override {
    const float* role = samples.picture(0, row);
    Moments taken, avoided;
    for (int r = 0; r < size_.rows; ++r)
      for (int c = 0; c < size_.columns; ++c, ++role)
        if (*role != 0) (*role > 0 ? taken : avoided).add(r, c, size_);
    Thing all;
    for (const Moments& moments : {taken, avoided})
      for (const double number : moments.result()) all.where.push_back(number);
    return {all};
  }

 private:
  PictureSize size_;
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
