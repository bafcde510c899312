// One training step of policy=heat_map: a batch of sixteen pictures forward and back, and Adam. Its convolutions copy
// what an empty patch gives, so the pictures are masks as a policy sees them: one object, of about 7 x 7 cells.
#include <benchmark/benchmark.h>
#include <torch/torch.h>

#include <algorithm>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/learning/heat_map_network.hpp>

#include "benchmarks.hpp"

namespace lgabench {
namespace {

constexpr int batch = 16, planes = 2, features = 16;
constexpr PictureSize grid = HeatMapNetwork::grid, padded = HeatMapNetwork::padded;

// A mask's pictures, one after the other, and a cell of each that is to be found.
struct Pictures {
  std::vector<float> numbers;
  std::vector<std::int64_t> wanted;
};

Pictures pictures() {
  RandomStream random("benchmarks/heat_map");
  Pictures all;
  for (int i = 0; i < batch; ++i) {
    constexpr int object = 7, border = HeatMapNetwork::border;
    const auto row = static_cast<int>(random.below(grid.rows - object + 1)),
               column = static_cast<int>(random.below(grid.columns - object + 1));
    for (int y = 0; y < padded.rows; ++y)
      for (int x = 0; x < padded.columns; ++x) {
        const int down = y - border - row, right = x - border - column;
        all.numbers.push_back(down >= 0 && down < object && right >= 0 && right < object ? 1.f : 0.f);
        all.numbers.push_back(0);  // nothing is to be avoided
      }
    all.wanted.push_back((row + object / 2) * grid.columns + column + object / 2);
  }
  return all;
}

void ours(benchmark::State& state) {
  const Pictures all = pictures();
  HeatMapNetwork network(Field(find_environment("tabletop").action_space()), planes, false, 1, 1,
                         *available_kernels().front());
  std::vector<float> wanted(HeatMapNetwork::cells);
  for (auto _ : state) {
    network.clear_gradients();
    for (int i = 0; i < batch; ++i) {
      const auto cell = static_cast<std::size_t>(all.wanted[static_cast<std::size_t>(i)]);
      network.map(all.numbers.data() + static_cast<std::size_t>(i) * padded.pixels() * planes, nullptr, nullptr);
      wanted[cell] = 1;
      benchmark::DoNotOptimize(network.teach(wanted, {}, 0, 1. / batch));
      wanted[cell] = 0;
    }
    network.update(1e-3);
  }
  state.SetItemsProcessed(state.iterations());
}

// As one writes it in LibTorch: modules, autograd and optim::Adam.
void torchs(benchmark::State& state) {
  namespace nn = torch::nn;
  at::set_num_threads(1);
  Pictures all = pictures();
  const torch::Tensor input = torch::from_blob(all.numbers.data(), {batch, padded.rows, padded.columns, planes})
                                  .permute({0, 3, 1, 2})
                                  .contiguous();
  const torch::Tensor wanted = torch::from_blob(all.wanted.data(), {batch}, torch::kLong);
  nn::Sequential network(nn::Conv2d(planes, features, 5), nn::ReLU(), nn::Conv2d(features, features, 3), nn::ReLU(),
                         nn::Conv2d(features, features, 3), nn::ReLU(),
                         nn::Conv2d(nn::Conv2dOptions(features, 1, 1).bias(false)), nn::Flatten());
  torch::optim::Adam adam(network->parameters(), torch::optim::AdamOptions(1e-3));
  for (auto _ : state) {
    const torch::Tensor loss = nn::functional::cross_entropy(network->forward(input), wanted);
    adam.zero_grad();
    loss.backward();
    adam.step();
    benchmark::DoNotOptimize(loss.item<float>());
  }
  state.SetItemsProcessed(state.iterations());
}

}  // namespace

void register_heat_map() {
  benchmark::RegisterBenchmark("step/heat_map", ours);
  benchmark::RegisterBenchmark("step/heat_map/libtorch", torchs);
}

}  // namespace lgabench
