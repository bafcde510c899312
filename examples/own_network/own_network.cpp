// A network of your own, in LibTorch: two linear layers on a coarse goal mask. lgabench makes its inputs, trains it in
// batches, logs the loss, plays the episodes and keeps the policy.
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/learning/torch_learner.hpp>
#include <lgabench/plugin/plugin.hpp>

using namespace lgabench;
namespace nn = torch::nn;

class OwnNetwork : public CloningMethod {
 public:
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    return select_features(command, space, services.lm);
  }
  PolicyInputs inputs(const Json&) const override {
    PolicyInputs inputs{{PolicyInputs::Picture::mask}};
    inputs.mask_size = {32, 64};
    return inputs;
  }
  std::unique_ptr<Learner> learner(const SampleShape& shape, const Services& services) const override {
    const int hidden = services.options.at("hidden"), numbers = shape.pictures[0].numbers();
    const auto make = [&] {
      const std::size_t actions = shape.actions.size();
      return nn::Sequential(nn::Flatten(), nn::Linear(numbers, hidden), nn::ReLU(), nn::Linear(hidden, actions));
    };
    return std::make_unique<TorchLearner<nn::Sequential>>(
        shape, services.seed, make, [](auto& network, auto& inputs) { return network->forward(inputs.pictures[0]); });
  }
};

// An option's default fixes its type; `lgabench info own_network` lists all, --set own_network.hidden=64 sets one.
LGABENCH_METHOD("own_network", "0.1", "Two linear layers on a coarse goal mask", OwnNetwork,
                "{" LGABENCH_TRAINING_OPTIONS R"(,
  "hidden": {"default": 128, "min": 1, "help": "units of the hidden layer", "source": "this example"}})")
