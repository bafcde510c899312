// A learner made of a LibTorch module. Header only: the plugin that includes it links LibTorch, lgabench does not.
#pragma once
#include <torch/torch.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <lgabench/learning/learner.hpp>

namespace lgabench {

/// What all learners in LibTorch share: Adam, one thread, and weights that follow from the seed.
class TorchTrained : public Learner {
 public:
  void update(double learning_rate) override {
    for (auto& group : optimizer_->param_groups()) group.options().set_lr(learning_rate);
    optimizer_->step();
  }
  std::vector<float> parameters() const override {
    std::vector<float> all;
    for (const torch::Tensor& one : trained_)
      all.insert(all.end(), one.data_ptr<float>(), one.data_ptr<float>() + one.numel());
    return all;
  }

 protected:
  /// Construct this before any module: LibTorch's own generator draws the initial weights.
  explicit TorchTrained(std::uint64_t seed) {
    torch::set_num_threads(1);  // a sum that is split among threads may differ in its last bit
    torch::manual_seed(seed);
  }
  /// Sets what update() moves, in the order of parameters().
  void train(std::vector<torch::Tensor> parameters) {
    trained_ = std::move(parameters);
    optimizer_ = std::make_unique<torch::optim::Adam>(trained_);
  }
  /// Keeps the gradients of `loss`, a single number, for update(). @returns that number.
  double descend(const torch::Tensor& loss) {
    optimizer_->zero_grad();
    loss.backward();
    return loss.item<double>();
  }

 private:
  std::vector<torch::Tensor> trained_;
  std::unique_ptr<torch::optim::Adam> optimizer_;
};

/// Rows of input as tensors.
struct TorchInputs {
  std::vector<torch::Tensor> pictures;  // rows x channels x rows of pixels x columns, in the order of PolicyInputs
  torch::Tensor text;                   // rows x 384; undefined where no text is asked for
};

/// Mean over rows of the L2 norm of the error, the loss of the comparison (docs/protocol.md, section 5).
inline torch::Tensor norm_loss(const torch::Tensor& actions, const torch::Tensor& labels) {
  return (actions - labels).norm(2, 1).mean();
}

/// A loss: a single number from actions and labels, which are both rows x numbers of an action.
using TorchLoss = std::function<torch::Tensor(const torch::Tensor& actions, const torch::Tensor& labels)>;

/// Trains a module. The method gives its forward and loss; lgabench gives batches, seed and schedule. `Module` is a
/// holder, such as torch::nn::Sequential.
template <class Module>
class TorchLearner : public TorchTrained {
 public:
  /// Computes the actions, rows x numbers of an action.
  using Forward = std::function<torch::Tensor(Module& module, const TorchInputs& inputs)>;

  /// `make` is called once, with the seed set. `forward` and `loss` may not refer to the method, which may be gone when
  /// the policy acts.
  TorchLearner(SampleShape shape, std::uint64_t seed, const std::function<Module()>& make, Forward forward,
               TorchLoss loss = norm_loss)
      : TorchTrained(seed),
        shape_(std::move(shape)),
        module_(make()),
        forward_(std::move(forward)),
        loss_(std::move(loss)) {
    train(module_->parameters());
  }

  const std::vector<float>& predict(const Samples& samples) override {
    const torch::NoGradGuard no_gradients;
    module_->eval();
    const torch::Tensor actions = forward_(module_, inputs(samples)).contiguous();
    predicted_.assign(actions.data_ptr<float>(), actions.data_ptr<float>() + actions.numel());
    return predicted_;
  }

  double backward(const Samples& samples, const std::vector<int>& batch) override {
    module_->train();
    const torch::Tensor rows = torch::tensor(at::ArrayRef<int>(batch));
    TorchInputs some = inputs(samples);
    for (torch::Tensor& picture : some.pictures) picture = picture.index_select(0, rows);
    if (some.text.defined()) some.text = some.text.index_select(0, rows);
    const torch::Tensor labels =
        view(samples.labels, {samples.rows, static_cast<std::int64_t>(shape_.actions.size())}).index_select(0, rows);
    return descend(loss_(forward_(module_, some), labels));
  }

  /// Saves parameters and buffers, or restores them into a module made with the same arguments.
  bool learned(Archive& archive) override {
    const torch::NoGradGuard no_gradients;
    std::vector<torch::Tensor> all = module_->parameters();
    for (const torch::Tensor& buffer : module_->buffers()) all.push_back(buffer);
    for (torch::Tensor& tensor : all) {
      const torch::Tensor as_double = tensor.to(torch::kDouble).contiguous();
      const double* const first = as_double.data_ptr<double>();
      std::vector<double> numbers(first, first + as_double.numel());
      archive(numbers);
      if (static_cast<std::int64_t>(numbers.size()) != tensor.numel()) Archive::fail();
      if (archive.reads()) tensor.copy_(torch::tensor(numbers, torch::kDouble).view(tensor.sizes()));
    }
    return true;
  }

 private:
  static torch::Tensor view(const std::vector<float>& numbers, at::IntArrayRef sizes) {
    return torch::from_blob(const_cast<float*>(numbers.data()), sizes);
  }
  TorchInputs inputs(const Samples& samples) const {
    TorchInputs all;
    for (std::size_t i = 0; i < shape_.pictures.size(); ++i) {
      const auto& [size, channels] = shape_.pictures[i];
      all.pictures.push_back(
          view(samples.pictures[i], {samples.rows, size.rows, size.columns, channels}).permute({0, 3, 1, 2}));
    }
    if (shape_.text) all.text = view(samples.text, {samples.rows, text_size});
    return all;
  }

  SampleShape shape_;
  Module module_;
  Forward forward_;
  TorchLoss loss_;
  std::vector<float> predicted_;
};

}  // namespace lgabench
