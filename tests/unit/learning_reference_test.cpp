// The network and Adam against LibTorch's own modules and optimiser.
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <cmath>

#include <lgabench/core/random.hpp>
#include <lgabench/learning/network.hpp>

namespace lgabench {
namespace {

namespace nn = torch::nn;

TEST(Adam, FollowsTorchsOverFiftySteps) {
  const std::int64_t size = 1000;
  RandomStream random("adam");
  torch::Tensor reference = torch::empty({size});
  for (std::int64_t i = 0; i < size; ++i) reference[i] = random.gaussian();
  std::vector<float> ours(reference.data_ptr<float>(), reference.data_ptr<float>() + size);
  reference.requires_grad_();
  reference.mutable_grad() = torch::zeros({size});
  torch::optim::Adam optimiser({reference}, torch::optim::AdamOptions(1e-3));
  Adam adam(size, 1e-3);
  for (int step = 0; step < 50; ++step) {
    float* gradient = reference.mutable_grad().data_ptr<float>();
    // From tiny to large, and some that vanish for a while.
    for (int i = 0; i < size; ++i)
      gradient[i] = (i + step) % 7 == 0 ? 0 : static_cast<float>(random.gaussian() * std::pow(10, i % 9 - 6));
    adam.step(ours.data(), gradient);
    optimiser.step();
  }
  for (std::int64_t i = 0; i < size; ++i)
    EXPECT_NEAR(ours[static_cast<std::size_t>(i)], reference[i].item<float>(), 1e-6) << i;
}

// The same network from torch's modules, its parameters in the order of ours.
struct Reference {
  std::vector<nn::Sequential> towers;
  nn::Linear text{nullptr}, head{nullptr};
  bool batch_norm;

  explicit Reference(const NetworkShape& shape) : batch_norm(shape.batch_norm) {
    for (const int channels : shape.channels) {
      nn::Sequential tower;
      const auto block = [&](int from, int to, int kernel, int stride) {
        tower->push_back(nn::Conv2d(nn::Conv2dOptions(from, to, kernel).stride(stride)));
        if (batch_norm) tower->push_back(nn::BatchNorm2d(to));
        tower->push_back(nn::ReLU());
      };
      block(channels, 32, 8, 4);
      block(32, 64, 4, 2);
      block(64, 32, 3, 1);
      towers.push_back(tower);
    }
    if (shape.text) text = nn::Linear(384, 100);
    head = nn::Linear(160 * static_cast<std::int64_t>(towers.size()) + (shape.text ? 100 : 0), 12);
  }

  std::vector<torch::Tensor> parameters() {
    std::vector<torch::Tensor> all;
    const auto add = [&all](const std::vector<torch::Tensor>& more) {
      all.insert(all.end(), more.begin(), more.end());
    };
    for (auto& tower : towers) add(tower->parameters());
    if (text) add(text->parameters());
    add(head->parameters());
    return all;
  }

  torch::Tensor forward(const NetworkShape& shape, const Samples& s) {
    const auto tensor = [&s](const std::vector<float>& values, std::vector<std::int64_t> sizes) {
      sizes.insert(sizes.begin(), s.rows);
      return torch::from_blob(const_cast<float*>(values.data()), sizes);
    };
    std::vector<torch::Tensor> features;
    for (std::size_t t = 0; t < towers.size(); ++t)
      features.push_back(towers[t]->forward(tensor(s.pictures[t], {shape.channels[t], 36, 72})).flatten(1));
    if (text) features.push_back(text(tensor(s.text, {384})));
    return head(torch::cat(features, 1));
  }
};

Samples random_samples(const NetworkShape& shape, int rows) {
  RandomStream random("samples");
  Samples s(shape, rows);
  for (auto& picture : s.pictures)
    for (float& value : picture) value = static_cast<float>(random.uniform());
  for (float& value : s.text) value = static_cast<float>(random.gaussian() / 20);
  for (float& value : s.labels) value = static_cast<float>(random.uniform());
  return s;
}

struct Case {
  const char* name;
  NetworkShape shape;
  std::size_t parameters;
};

class Networks : public testing::TestWithParam<Case> {};

TEST_P(Networks, HaveTorchsOutputsLossAndGradients) {
  const NetworkShape& shape = GetParam().shape;
  Network network(shape, 3);
  EXPECT_EQ(network.size(), GetParam().parameters);

  Reference reference(shape);
  std::size_t begin = 0;
  for (torch::Tensor& p : reference.parameters()) {
    const torch::NoGradGuard no_grad;
    p.copy_(torch::from_blob(network.parameters() + begin, p.sizes()));
    begin += static_cast<std::size_t>(p.numel());
  }
  ASSERT_EQ(begin, network.size());

  const Samples samples = random_samples(shape, 10);
  const torch::Tensor labels = torch::from_blob(const_cast<float*>(samples.labels.data()), {10, 12});
  const torch::Tensor loss = (reference.forward(shape, samples) - labels).norm(2, 1).mean();
  loss.backward();
  EXPECT_NEAR(network.backward(samples, Loss::norm), loss.item<double>(), 1e-6);
  begin = 0;
  for (const torch::Tensor& p : reference.parameters()) {
    const torch::Tensor ours = torch::from_blob(const_cast<float*>(network.gradients()) + begin, p.sizes());
    const double scale = p.grad().abs().max().item<double>();
    // A bias before batch normalisation has gradient 0 but for rounding.
    EXPECT_LT((ours - p.grad()).abs().max().item<double>(), 1e-5 * scale + 1e-6) << "parameters from " << begin;
    begin += static_cast<std::size_t>(p.numel());
  }

  for (auto& tower : reference.towers) tower->eval();  // running statistics, which the pass above moved
  const torch::Tensor outputs = reference.forward(shape, samples).contiguous();
  const std::vector<float> predicted = network.predict(samples);
  ASSERT_EQ(predicted.size(), 120u);
  for (std::size_t i = 0; i < predicted.size(); ++i) EXPECT_NEAR(predicted[i], outputs.data_ptr<float>()[i], 1e-5);
}

// A tower has 32(64c + 1) + 64(512 + 1) + 32(576 + 1) parameters, the text layer 100(384 + 1), the head 12 a feature
// + 12.
INSTANTIATE_TEST_SUITE_P(Shapes, Networks,
                         testing::Values(Case{"mask", {{1}, false, false}, 55308},
                                         Case{"rgb_and_text", {{3}, true, false}, 99104},
                                         Case{"mask_and_rgb", {{1, 3}, false, false}, 53376 + 57472 + 3852},
                                         Case{"batch_norm", {{1}, false, true}, 55308 + 2 * (32 + 64 + 32)}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace lgabench
