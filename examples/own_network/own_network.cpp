// A method with a network of its own: two linear layers on a coarse goal mask, trained with LibTorch's autograd.
// Shows options, the training log, the seed, and how LibTorch is kept reproducible.
#include <torch/torch.h>

#include <algorithm>
#include <utility>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/plugin/plugin.hpp>

namespace {

using namespace lgabench;

constexpr int coarse = 4, features = (Observation::rows / coarse) * (Observation::columns / coarse);  // 32 x 64

// The goal mask as 1 x 2048: 1 where any of 4 x 4 pixels is kept.
torch::Tensor input_of(const Observation& observation, const Selection& selection) {
  const std::vector<std::uint8_t> mask = goal_mask(observation, selection);
  const torch::Tensor pixels = torch::tensor(at::ArrayRef<std::uint8_t>(mask), torch::kFloat);
  return torch::max_pool2d(pixels.view({1, 1, Observation::rows, Observation::columns}), coarse).view({1, features});
}

// What it acts with holds no reference to the Method, which may be gone by then.
class NetworkPolicy : public Policy {
 public:
  explicit NetworkPolicy(torch::nn::Sequential network) : network_(std::move(network)) {}

  Action act(const Observation& observation, const Instruction& instruction) override {
    const torch::NoGradGuard no_gradients;
    const torch::Tensor output = network_->forward(input_of(observation, instruction.selection)).contiguous();
    ActionVector action;
    std::copy_n(output.data_ptr<float>(), action.size(), action.begin());
    return from_vector(action);
  }

 private:
  torch::nn::Sequential network_;
};

class OwnNetwork : public Method {
 public:
  Needs needs(const Json&) const override { return {}; }

  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    return select_features(command, space, services.lm);
  }

  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    const int epochs = services.options.at("epochs"), hidden = services.options.at("hidden");
    torch::set_num_threads(1);          // a sum that is split among threads has another last bit
    torch::manual_seed(services.seed);  // initial weights and the order below: the same seed, the same policy

    std::vector<torch::Tensor> inputs, labels;
    for (const Demonstration& demonstration : demonstrations)
      for (const Step& step : demonstration.steps) {
        inputs.push_back(input_of(step.observation, demonstration.instruction.selection));
        const ActionVector label = to_vector(step.label);
        labels.push_back(torch::tensor(at::ArrayRef<float>(label.data(), label.size())).view({1, -1}));
      }
    if (inputs.empty()) throw MethodError("own_network needs a demonstration");
    const torch::Tensor x = torch::cat(inputs), y = torch::cat(labels);

    torch::nn::Sequential network(torch::nn::Linear(features, hidden), torch::nn::ReLU(),
                                  torch::nn::Linear(hidden, static_cast<std::int64_t>(ActionVector().size())));
    torch::optim::Adam optimizer(network->parameters(), 1e-3);
    long long steps = 0;
    for (int epoch = 1; epoch <= epochs; ++epoch) {
      double sum = 0;
      const std::vector<torch::Tensor> batches = torch::randperm(x.size(0)).split(10);
      for (const torch::Tensor& batch : batches) {
        optimizer.zero_grad();
        const torch::Tensor error = network->forward(x.index_select(0, batch)) - y.index_select(0, batch);
        const torch::Tensor loss = error.norm(2, 1).mean();
        loss.backward();
        optimizer.step();
        sum += loss.item<double>();
        ++steps;
      }
      if (epoch % 10 == 0 || epoch == epochs)
        services.log.epoch(epoch, steps, sum / static_cast<double>(batches.size()));
    }
    return std::make_unique<NetworkPolicy>(network);
  }
};

}  // namespace

// An option's default fixes its type; `lgabench info own_network` prints this, --set own_network.hidden=64 sets one.
LGABENCH_METHOD("own_network", "0.1", "Two linear layers on a coarse goal mask", OwnNetwork, R"({
  "epochs": {"default": 300, "min": 1, "help": "passes over the demonstrations", "source": "this example"},
  "hidden": {"default": 128, "min": 1, "help": "units of the hidden layer", "source": "this example"}})")
