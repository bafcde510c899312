// The abstraction in the input, object by object: of each instance whether it is to be taken or to be avoided, its
// colour, where it lies and how it is turned. After VIMA's object tokens (Jiang et al., ICML 2023, arXiv 2210.03094)
// and attention over object proposals (Devin et al., ICRA 2018, arXiv 1708.04225), without pretrained features.
#include <map>

#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

#include "set_learner.hpp"

using namespace lgabench;

namespace {

class Objects : public SetLearner {
 public:
  static constexpr std::size_t roles = 2, colours = 3;

  Objects(const SampleShape& shape, std::uint64_t seed)
      : SetLearner(shape.actions, roles + colours, Moments::numbers, "set_network", seed),
        size_(shape.pictures[0].size) {}

 protected:
  Set set_of(const Samples& samples, int row) const override {
    struct Pixels {
      Moments moments;
      std::array<double, roles + colours> sums{};
    };
    std::map<float, Pixels> instances;
    for (int r = 0, pixel = 0; r < size_.rows; ++r)
      for (int c = 0; c < size_.columns; ++c, ++pixel) {
        const float id = samples.picture(0, row)[pixel], role = samples.picture(1, row)[pixel];
        if (id == 0) continue;
        Pixels& of = instances[id];
        of.moments.add(r, c, size_);
        of.sums[0] += role > 0;
        of.sums[1] += role < 0;
        const float* colour = samples.picture(2, row) + static_cast<std::size_t>(pixel) * colours;
        for (std::size_t k = 0; k < colours; ++k) of.sums[roles + k] += colour[k];
      }
    Set set;
    for (const auto& [id, pixels] : instances) {
      Thing& thing = set.emplace_back();
      for (const double sum : pixels.sums) thing.what.push_back(sum / pixels.moments.counted());
      for (std::size_t k = 0; k < roles; ++k) thing.what[k] = thing.what[k] > .5;  // a mask is a pixel wider than ids
      for (const double number : pixels.moments.result()) thing.where.push_back(number);
    }
    if (set.empty()) set.push_back({std::vector<double>(roles + colours), std::vector<double>(Moments::numbers)});
    return set;
  }

 private:
  PictureSize size_;
};

}  // namespace

class SetNetwork : public CloningMethod {
 public:
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    return select_as_asked(command, space, services);
  }

 protected:
  PolicyInputs inputs(const Json&) const override {
    using Picture = PolicyInputs::Picture;
    PolicyInputs inputs{{Picture::instances, Picture::mask, Picture::rgb}};
    inputs.signed_mask = true;
    inputs.mask_size = inputs.rgb_size = {2 * input_rows, 2 * input_columns};
    return inputs;
  }
  std::unique_ptr<Learner> learner(const SampleShape& shape, const Services& services) const override {
    return std::make_unique<Objects>(shape, services.seed);
  }
};

LGABENCH_METHOD("set_network", "0.1",
                "A small network on all instances, each with whether a language model selected it", SetNetwork,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_TRAINING_OPTIONS "}")
