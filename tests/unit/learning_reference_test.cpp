// The network and Adam against LibTorch's own modules and optimiser.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <cmath>
#include <numeric>

#include <lgabench/core/json.hpp>
#include <lgabench/learning/network.hpp>

#include "random_samples.hpp"

namespace lgabench {
namespace {

namespace nn = torch::nn;

constexpr auto text = Architecture::text, released = Architecture::released, plain = Architecture::plain;

// Of Adam: after batch normalisation of ReLU's outputs rounding grows tenfold every few steps of 1e-3, in PyTorch's
// single against its double precision alike.
double learning_rate(const NetworkShape& shape) {
  return shape.architecture == released && !shape.channels.empty() ? 1e-4 : 1e-3;
}

// The same network from torch's modules, its parameters in the order of ours. In double precision: in single, torch's
// own gradient of `released` on 25 rows is off by 2 % of its norm.
struct Reference {
  std::vector<nn::Sequential> towers;
  std::vector<nn::Linear> own;  // of each tower in the released code's network with text, and in a wide one
  nn::Linear words{nullptr}, joined{nullptr}, last{nullptr};

  explicit Reference(const NetworkShape& shape) {
    const bool leaky = shape.architecture == released, deep = leaky && shape.text;
    for (const int channels : shape.channels) {
      nn::Sequential tower;
      const auto block = [&](int from, int to, int kernel, int stride, bool is_last = false) {
        tower->push_back(nn::Conv2d(nn::Conv2dOptions(from, to, kernel).stride(stride)));
        if (shape.architecture == text) tower->push_back(nn::BatchNorm2d(to));
        if (leaky && is_last)
          tower->push_back(nn::LeakyReLU());
        else
          tower->push_back(nn::ReLU());
        if (leaky) tower->push_back(nn::BatchNorm2d(to));
      };
      block(channels, 32, 8, 4);
      block(32, 64, 4, 2);
      block(64, 32, 3, 1, true);
      towers.push_back(tower);
      if (deep || shape.wide) own.push_back(nn::Linear(160, shape.wide ? 1000 : 100));
    }
    const auto count = static_cast<std::int64_t>(towers.size());
    if (deep) {
      joined = nn::Linear(100 * count + 384, 100);
      last = nn::Linear(100, 12);
    } else {
      if (shape.text) words = nn::Linear(384, 100);
      joined = nn::Linear((shape.wide ? 1000 : 160) * count + (shape.text ? 100 : 0), 12);
    }
    for (auto& tower : towers) tower->to(torch::kFloat64);
    for (auto& linear : own) linear->to(torch::kFloat64);
    for (nn::Linear linear : {words, joined, last})
      if (linear) linear->to(torch::kFloat64);
  }

  std::vector<torch::Tensor> parameters() {
    std::vector<torch::Tensor> all;
    const auto add = [&all](const std::vector<torch::Tensor>& more) {
      all.insert(all.end(), more.begin(), more.end());
    };
    for (auto& tower : towers) add(tower->parameters());
    for (auto& linear : own) add(linear->parameters());
    for (auto& linear : {words, joined, last})
      if (linear) add(linear->parameters());
    return all;
  }

  torch::Tensor forward(const NetworkShape& shape, const Samples& s) {
    const auto tensor = [&s](const std::vector<float>& values, std::vector<std::int64_t> sizes) {
      sizes.insert(sizes.begin(), s.rows);
      return torch::from_blob(const_cast<float*>(values.data()), sizes).to(torch::kFloat64);
    };
    // Ours has channels last.
    std::vector<torch::Tensor> features;
    for (std::size_t t = 0; t < towers.size(); ++t) {
      features.push_back(
          towers[t]
              ->forward(tensor(s.pictures[t], {36, 72, shape.channels[t]}).permute({0, 3, 1, 2}).contiguous())
              .flatten(1));
      if (!own.empty()) features.back() = own[t](features.back());
    }
    if (words) features.push_back(words(tensor(s.text, {384})));
    if (last) features.push_back(tensor(s.text, {384}));
    const torch::Tensor output = joined(torch::cat(features, 1));
    return last ? last(torch::relu(output)) : output;
  }
};

struct Case {
  const char* name;
  NetworkShape shape;
  std::size_t parameters;
};

// Ours and torch's, with the same weights.
class Pair {
 public:
  Pair(const NetworkShape& wanted, const Kernels& kernels)
      : shape(wanted),
        ours(wanted, 3, Loss::norm, kernels),
        torchs(wanted),
        optimiser_(torchs.parameters(), learning_rate(wanted)) {
    std::vector<float> first = ours.parameters();
    float* begin = first.data();
    for (torch::Tensor& p : torchs.parameters()) {
      const torch::NoGradGuard no_grad;
      p.copy_(torch::from_blob(begin, p.sizes()));
      begin += p.numel();
    }
    EXPECT_EQ(begin, first.data() + first.size());
  }

  double torchs_backward(const Samples& samples) {
    const torch::Tensor labels = torch::from_blob(const_cast<float*>(samples.labels.data()), {samples.rows, 12});
    const torch::Tensor loss = (torchs.forward(shape, samples) - labels).norm(2, 1).mean();
    optimiser_.zero_grad();
    loss.backward();
    return loss.item<double>();
  }
  void torchs_update() { optimiser_.step(); }

  NetworkShape shape;
  Network ours;
  Reference torchs;

 private:
  torch::optim::Adam optimiser_;
};

class Networks : public testing::TestWithParam<std::tuple<Case, const Kernels*>> {};

TEST_P(Networks, HaveTorchsOutputsLossAndGradients) {
  const auto& [tested, kernels] = GetParam();
  Pair pair(tested.shape, *kernels);
  EXPECT_EQ(pair.ours.parameters().size(), tested.parameters);

  // 10 as in training, 3 as where there are few, 25 so that buffers grow.
  for (const int rows : {10, 3, 25})
    for (const bool alike : {false, true}) {
      if (alike && rows == 25) continue;  // so many rounded numbers that one opens a ReLU
      const Samples samples = (alike ? mostly_alike : random_samples)(tested.shape, rows);
      if (alike) pair.ours.begin(samples);
      EXPECT_NEAR(pair.ours.backward(samples, all_rows(samples)), pair.torchs_backward(samples),
                  tested.shape.architecture == plain ? 1e-6 : 1e-5);
      const std::vector<float> gradients = pair.ours.gradients();
      const float* begin = gradients.data();
      for (const torch::Tensor& p : pair.torchs.parameters()) {
        const torch::Tensor ours = torch::from_blob(const_cast<float*>(begin), p.sizes());
        const torch::Tensor error = ours - p.grad();
        const auto what =
            fmt::format("{} rows{}, parameters from {}", rows, alike ? " mostly alike" : "", begin - gradients.data());
        if (tested.shape.architecture == plain) {
          EXPECT_LT(error.abs().max().item<double>(), 1e-5 * p.grad().abs().max().item<double>() + 1e-6) << what;
        } else {
          // It enlarges rounding, which may open a ReLU; a bias before it has gradient 0 but for that.
          EXPECT_LT(error.norm().item<double>(), 5e-3 * p.grad().norm().item<double>() + 1e-4) << what;
        }
        begin += p.numel();
      }
    }

  for (auto& tower : pair.torchs.towers) tower->eval();  // running statistics, which the passes above moved
  const Samples samples = random_samples(tested.shape, 10);
  const torch::Tensor outputs = pair.torchs.forward(tested.shape, samples).contiguous();
  const std::vector<float> predicted = pair.ours.predict(samples);
  ASSERT_EQ(predicted.size(), 120u);
  const double tolerance = tested.shape.architecture == plain ? 1e-5 : 1e-4;
  for (std::size_t i = 0; i < predicted.size(); ++i)
    EXPECT_NEAR(predicted[i], outputs.data_ptr<double>()[i], tolerance);
}

TEST_P(Networks, TakeTheRowsThatABatchNames) {
  const auto& [tested, kernels] = GetParam();
  Network network(tested.shape, 3, Loss::norm, *kernels);
  const Samples samples = random_samples(tested.shape, 6);
  const double one = network.backward(samples, {4}), other = network.backward(samples, {1});
  if (tested.shape.architecture == Architecture::plain) {
    EXPECT_NEAR(network.backward(samples, {1, 4}), (one + other) / 2, 1e-6);
    const double empty = network.backward(samples, {3});  // where there are masks
    EXPECT_NEAR(network.backward(samples, {1, 3}), (other + empty) / 2, 1e-6);
  }
  EXPECT_NE(one, other);
}

TEST_P(Networks, FollowTorchsAdamOverTwentySteps) {
  const auto& [tested, kernels] = GetParam();
  Pair pair(tested.shape, *kernels);
  const Samples samples = random_samples(tested.shape, 10);
  for (int step = 0; step < 20; ++step) {
    ASSERT_NEAR(pair.ours.backward(samples, all_rows(samples)), pair.torchs_backward(samples),
                tested.shape.architecture == released ? 1e-3 : 1e-4)
        << step;
    pair.ours.update(learning_rate(tested.shape));
    pair.torchs_update();
  }
}

// A tower has 32(64c + 1) + 64(512 + 1) + 32(576 + 1) parameters and 2(32 + 64 + 32) of batch normalisation, the text
// layer 100(384 + 1), the head 12 a feature + 12; `released` with text 100(160 + 1) a tower, 100(100 a tower + 385),
// 1212.
constexpr std::size_t mask_tower = 53376, rgb_tower = 57472, fused_tower = 59520, norms = 256;
INSTANTIATE_TEST_SUITE_P(
    Shapes, Networks,
    testing::Combine(
        testing::Values(
            Case{"plain_mask", {{1}, false, plain}, 55308}, Case{"plain_rgb_and_text", {{3}, true, plain}, 99104},
            Case{"plain_mask_and_rgb", {{1, 3}, false, plain}, mask_tower + rgb_tower + 3852},
            Case{"plain_rgb_segmentation_and_text", {{3, 1}, true, plain}, rgb_tower + mask_tower + 38500 + 5052},
            Case{"plain_text", {{}, true, plain}, 38500 + 1212},
            Case{"wide_mask", {{1}, false, plain, 12, true}, mask_tower + 161000 + 12012},
            Case{"wide_rgb_segmentation_and_text",
                 {{3, 1}, true, plain, 12, true},
                 rgb_tower + mask_tower + 2 * 161000 + 38500 + 25212},
            Case{"plain_fused", {{4}, false, plain}, fused_tower + 1932},
            Case{"text_fused", {{4}, false, text}, fused_tower + norms + 1932},
            Case{"text_mask", {{1}, false, text}, mask_tower + norms + 1932},
            Case{"text_rgb_and_text", {{3}, true, text}, rgb_tower + norms + 38500 + 3132},
            Case{"text_mask_and_rgb", {{1, 3}, false, text}, mask_tower + rgb_tower + 2 * norms + 3852},
            Case{"text_rgb_segmentation_and_text",
                 {{3, 1}, true, text},
                 rgb_tower + mask_tower + 2 * norms + 38500 + 5052},
            Case{"released_mask", {{1}, false, released}, mask_tower + norms + 1932},
            Case{"released_rgb_and_text", {{3}, true, released}, rgb_tower + norms + 16100 + 48500 + 1212},
            Case{"released_mask_and_rgb", {{1, 3}, false, released}, mask_tower + rgb_tower + 2 * norms + 3852},
            Case{"released_rgb_segmentation_and_text",
                 {{3, 1}, true, released},
                 rgb_tower + mask_tower + 2 * norms + 2 * 16100 + 58500 + 1212},
            Case{"released_text", {{}, true, released}, 38500 + 1212}),
        testing::ValuesIn(available_kernels())),
    [](const auto& tested) {
      return std::string(std::get<0>(tested.param).name) + "_" + std::get<1>(tested.param)->name;
    });

// The formula of make_loss_curves.py.
std::vector<float> numbers(std::uint64_t key, std::size_t count) {
  std::vector<float> all(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t x = ((i + 1) * 2654435761u + key * 40503u) % (std::uint64_t{1} << 32);
    x = ((x ^ (x >> 15)) * 2246822519u) % (std::uint64_t{1} << 32);
    all[i] = static_cast<float>(static_cast<double>(x ^ (x >> 13)) / 4294967296.);
  }
  return all;
}

// The parameters that make_loss_curves.py begins with.
std::vector<float> first_parameters(const NetworkShape& shape, std::size_t count) {
  std::vector<float> all = numbers(3, count);
  auto number = all.begin();
  const auto fill = [&number](int out, int fan_in, bool normalised) {
    for (int i = 0; i < out * fan_in; ++i, ++number)
      *number = (*number - .5f) * 2 / std::sqrt(static_cast<float>(fan_in));
    for (int i = 0; i < out; ++i, ++number) *number = (*number - .5f) / 10;
    if (!normalised) return;
    for (int i = 0; i < out; ++i, ++number) *number = 1;
    for (int i = 0; i < out; ++i, ++number) *number = (*number - .5f) / 10;
  };
  for (const int channels : shape.channels)
    for (const auto& [out, fan_in] : {std::pair(32, 64 * channels), std::pair(64, 512), std::pair(32, 576)})
      fill(out, fan_in, shape.architecture != plain);
  const int towers = static_cast<int>(shape.channels.size());
  if (shape.architecture == released && shape.text) {
    for (int tower = 0; tower < towers; ++tower) fill(100, 160, false);
    fill(100, 100 * towers + 384, false);
    fill(12, 100, false);
  } else {
    if (shape.text) fill(100, 384, false);
    fill(12, 160 * towers + (shape.text ? 100 : 0), false);
  }
  EXPECT_EQ(number, all.end());
  return all;
}

TEST(Training, HasTheLossCurvesOfPyTorch) {
  const Json document = read_json(LGABENCH_TEST_REFERENCE "/loss_curves.json");
  ASSERT_EQ(document.at("curves").size(), 18u);
  for (const Json& curve : document.at("curves")) {
    NetworkShape shape;
    shape.channels = curve.at("channels").get<std::vector<int>>();
    shape.text = curve.at("text");
    const std::string network_name = curve.at("network");
    shape.architecture = network_name == "text" ? text : network_name == "plain" ? plain : released;
    Network network(shape, 0, curve.at("squared") ? Loss::squared : Loss::norm);
    network.set_parameters(first_parameters(shape, network.parameters().size()));
    Samples samples(shape.samples(), 40);
    for (std::size_t t = 0; t < shape.channels.size(); ++t)
      samples.pictures[t] = numbers(10 + t, samples.pictures[t].size());
    samples.text = numbers(20, samples.text.size());
    for (float& number : samples.text) number = (number - .5f) / 5;
    samples.labels = numbers(30, samples.labels.size());

    const auto expected = curve.at("losses").get<std::vector<double>>();
    ASSERT_EQ(expected.size(), 50u);
    double furthest = 0;
    for (int step = 0; step < 50; ++step) {
      std::vector<int> batch;
      for (int i = 0; i < 10; ++i) batch.push_back((step * 10 + i) % 40);
      furthest =
          std::max(furthest, std::abs(network.backward(samples, batch) - expected[static_cast<std::size_t>(step)]));
      network.update(learning_rate(shape));
    }
    EXPECT_LT(furthest, shape.architecture == released ? 1e-3 : 1e-4) << curve.at("input") << ", " << network_name;
    EXPECT_LT(expected.back(), .9 * expected.front()) << "the curve shows no learning";
  }
}

}  // namespace
}  // namespace lgabench
