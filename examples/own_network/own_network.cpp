// A network of your own, in LibTorch: two linear layers on the goal mask. lgabench makes its inputs, trains it in
// batches, logs the loss and plays the episodes. Shows a Learner, an option, the input's size, and how to keep LibTorch
// reproducible.
#include <torch/torch.h>

#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

namespace {

using namespace lgabench;

class TwoLayers : public Learner {
 public:
  TwoLayers(const SampleShape& shape, int hidden, std::uint64_t seed)
      : numbers_(shape.pictures[0].numbers()), actions_(static_cast<int>(shape.actions.size())) {
    torch::set_num_threads(1);  // a sum that is split among threads may differ in its last bit
    torch::manual_seed(seed);   // of the initial weights
    network_ = torch::nn::Sequential(torch::nn::Linear(numbers_, hidden), torch::nn::ReLU(),
                                     torch::nn::Linear(hidden, actions_));
    optimizer_ = std::make_unique<torch::optim::Adam>(network_->parameters());
  }

  const std::vector<float>& predict(const Samples& samples) override {
    const torch::NoGradGuard no_gradients;
    const torch::Tensor actions = network_->forward(pictures(samples)).contiguous();
    predicted_.assign(actions.data_ptr<float>(), actions.data_ptr<float>() + actions.numel());
    return predicted_;
  }

  double backward(const Samples& samples, const std::vector<int>& batch) override {
    const torch::Tensor rows = torch::tensor(at::ArrayRef<int>(batch));
    const torch::Tensor labels = tensor(samples.labels, actions_).index_select(0, rows);
    optimizer_->zero_grad();
    const torch::Tensor loss = (network_->forward(pictures(samples).index_select(0, rows)) - labels).norm(2, 1).mean();
    loss.backward();
    return loss.item<double>();
  }

  void update(double learning_rate) override {
    for (auto& group : optimizer_->param_groups()) group.options().set_lr(learning_rate);
    optimizer_->step();
  }

  std::vector<float> parameters() const override {
    std::vector<float> all;
    for (const torch::Tensor& p : network_->parameters())
      all.insert(all.end(), p.data_ptr<float>(), p.data_ptr<float>() + p.numel());
    return all;
  }

 private:
  // A view of `values` as rows of `a_row` numbers each.
  static torch::Tensor tensor(const std::vector<float>& values, std::int64_t a_row) {
    const auto rows = static_cast<std::int64_t>(values.size()) / a_row;
    return torch::from_blob(const_cast<float*>(values.data()), {rows, a_row});
  }
  torch::Tensor pictures(const Samples& samples) const { return tensor(samples.pictures[0], numbers_); }

  std::int64_t numbers_, actions_;  // of a picture, of an action
  torch::nn::Sequential network_;
  std::unique_ptr<torch::optim::Adam> optimizer_;
  std::vector<float> predicted_;
};

class OwnNetwork : public CloningMethod {
 public:
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    return select_features(command, space, services.lm);
  }

 protected:
  PolicyInputs inputs(const Json&) const override {
    PolicyInputs inputs{{PolicyInputs::Picture::mask}};
    inputs.mask_size = {32, 64};
    return inputs;
  }
  std::unique_ptr<Learner> learner(const SampleShape& shape, const Services& services) const override {
    return std::make_unique<TwoLayers>(shape, services.options.at("hidden"), services.seed);
  }
};

}  // namespace

// An option's default fixes its type; `lgabench info own_network` prints this, --set own_network.hidden=64 sets one.
LGABENCH_METHOD("own_network", "0.1", "Two linear layers on a coarse goal mask", OwnNetwork,
                "{" LGABENCH_TRAINING_OPTIONS R"(,
  "hidden": {"default": 128, "min": 1, "help": "units of the hidden layer", "source": "this example"}})")
