// One training step: forward, backward and Adam on a batch of ten, as a cell of fifty demonstrations has them. What a
// step costs depends on how much in the pictures is empty, so they are of scenes and not random.
#include <benchmark/benchmark.h>
#include <torch/torch.h>

#include <numeric>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/learning/network.hpp>
#include <lgabench/learning/sentence_embeddings.hpp>
#include <tabletop/renderer.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/two_poses.hpp>

#include "benchmarks.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace lgabench {
namespace {

constexpr int rows = 10, batches = 5;

// Of the dense arithmetic: forward and weight gradient of every layer; input gradient of all but the first of each
// tower.
double flops_of(const NetworkShape& shape) {
  double flops = 0;
  for (const int channels : shape.channels) {
    const double first = 136. * 32 * 64 * channels, rest = 21. * 64 * 512 + 5. * 32 * 576, head = 160. * 12;
    flops += 2 * (2 * first + 3 * rest + 3 * head);
  }
  if (shape.text) flops += 2 * (2 * 384. * 100 + 3 * 100. * 12);
  return rows * flops;
}

const std::vector<std::pair<const char*, NetworkShape>>& shapes() {
  static const std::vector<std::pair<const char*, NetworkShape>> all = {{"mask", {{1}}},
                                                                        {"rgb_and_text", {{3}, true}},
                                                                        {"mask_and_rgb", {{1, 3}}},
                                                                        {"rgb_segmentation_and_text", {{3, 1}, true}}};
  return all;
}

// Training scenes of "Bring me the heart." with the place of the target as the label.
Samples samples_of(const NetworkShape& shape) {
  const Scenario scenario = load_scenario("heart");
  const ScenarioCommand& command = scenario.commands.front();
  tabletop::Renderer renderer;
  Samples samples(shape.samples(), rows * batches);
  for (int i = 0; i < samples.rows; ++i) {
    const Scene scene = tabletop::sample_scene(scenario, {"cells", "train", "train", 0}, i);
    const Observation seen = renderer.render(tabletop::visible_objects(scene));
    for (std::size_t t = 0; t < shape.channels.size(); ++t) {
      float* const picture = samples.picture(t, i);
      if (shape.channels[t] == 1)
        shrink_mask(goal_mask(seen, command.truth), seen.size, input_size, picture);
      else
        shrink_rgb(seen.rgb, seen.size, input_size, picture);
    }
    if (shape.text) {
      static SentenceEmbeddings embeddings;
      const std::vector<float>& text = embeddings.of(command.utterance);
      std::copy(text.begin(), text.end(), samples.text.begin() + i * text_size);
    }
    const Action label = tabletop::TwoPoses{{scene.find(role::target)->position_m, {}}, {{.5, .3}, {}}};
    std::copy(label.begin(), label.end(), samples.labels.begin() + i * std::ptrdiff_t{12});
  }
  return samples;
}

void report(benchmark::State& state, const NetworkShape& shape) {
  state.SetItemsProcessed(state.iterations());
  state.counters["flops"] =
      benchmark::Counter(flops_of(shape) * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void ours(benchmark::State& state, const NetworkShape& shape, const Kernels& kernels) {
  Network network(shape, 1, Loss::norm, kernels);
  const Samples samples = samples_of(shape);
  network.begin(samples);
  std::vector<int> batch(rows);
  int step = 0;
  for (auto _ : state) {
    std::iota(batch.begin(), batch.end(), rows * (step++ % batches));
    benchmark::DoNotOptimize(network.backward(samples, batch));
    network.update(1e-3);
  }
  report(state, shape);
}

// As one writes it in LibTorch: modules, autograd and optim::Adam.
void torchs(benchmark::State& state, const NetworkShape& shape) {
  namespace nn = torch::nn;
  at::set_num_threads(1);
  const Samples samples = samples_of(shape);
  // Batch number b of an array with so many numbers a row.
  const auto batch_of = [](const std::vector<float>& values, int b, std::vector<std::int64_t> sizes) {
    std::int64_t numbers = rows;
    for (const std::int64_t s : sizes) numbers *= s;
    sizes.insert(sizes.begin(), rows);
    return torch::from_blob(const_cast<float*>(values.data()) + b * numbers, sizes);
  };
  std::vector<nn::Sequential> towers;
  std::vector<torch::Tensor> parameters;
  std::vector<std::vector<torch::Tensor>> pictures(shape.channels.size());  // of each tower, each batch
  const auto add = [&parameters](const std::vector<torch::Tensor>& more) {
    parameters.insert(parameters.end(), more.begin(), more.end());
  };
  for (std::size_t t = 0; t < shape.channels.size(); ++t) {
    const int channels = shape.channels[t];
    towers.push_back(nn::Sequential(nn::Conv2d(nn::Conv2dOptions(channels, 32, 8).stride(4)), nn::BatchNorm2d(32),
                                    nn::ReLU(), nn::Conv2d(nn::Conv2dOptions(32, 64, 4).stride(2)), nn::BatchNorm2d(64),
                                    nn::ReLU(), nn::Conv2d(nn::Conv2dOptions(64, 32, 3)), nn::BatchNorm2d(32),
                                    nn::ReLU(), nn::Flatten()));
    add(towers.back()->parameters());
    for (int b = 0; b < batches; ++b)
      pictures[t].push_back(batch_of(samples.pictures[t], b, {36, 72, channels}).permute({0, 3, 1, 2}).contiguous());
  }
  nn::Linear text(384, 100), head(160 * static_cast<std::int64_t>(towers.size()) + (shape.text ? 100 : 0), 12);
  if (shape.text) add(text->parameters());
  add(head->parameters());
  torch::optim::Adam adam(parameters, torch::optim::AdamOptions(1e-3));
  int step = 0;
  for (auto _ : state) {
    const int b = step++ % batches;
    std::vector<torch::Tensor> features;
    for (std::size_t t = 0; t < towers.size(); ++t)
      features.push_back(towers[t]->forward(pictures[t][static_cast<std::size_t>(b)]));
    if (shape.text) features.push_back(text(batch_of(samples.text, b, {text_size})));
    const torch::Tensor loss = (head(torch::cat(features, 1)) - batch_of(samples.labels, b, {12})).norm(2, 1).mean();
    adam.zero_grad();
    loss.backward();
    adam.step();
    benchmark::DoNotOptimize(loss.item<float>());
  }
  report(state, shape);
}

#if defined(__x86_64__)
constexpr int rounds = 1000, sums = 12;  // enough sums to hide the latency of each

__attribute__((target("avx512f"), noipa)) void multiply_add_512(float x, float y, float* out) {
  const __m512 factor = _mm512_set1_ps(x), addend = _mm512_set1_ps(y);
  __m512 sum[sums];
  for (auto& s : sum) s = addend;
  for (int k = 0; k < rounds; ++k)
#pragma GCC unroll 12
    for (int i = 0; i < sums; ++i) sum[i] = _mm512_fmadd_ps(sum[i], factor, addend);
  for (int i = 1; i < sums; ++i) sum[0] = _mm512_add_ps(sum[0], sum[i]);
  _mm512_storeu_ps(out, sum[0]);
}

__attribute__((target("avx2,fma"), noipa)) void multiply_add_256(float x, float y, float* out) {
  const __m256 factor = _mm256_set1_ps(x), addend = _mm256_set1_ps(y);
  __m256 sum[sums];
  for (auto& s : sum) s = addend;
  for (int k = 0; k < rounds; ++k)
#pragma GCC unroll 12
    for (int i = 0; i < sums; ++i) sum[i] = _mm256_fmadd_ps(sum[i], factor, addend);
  for (int i = 1; i < sums; ++i) sum[0] = _mm256_add_ps(sum[0], sum[i]);
  _mm256_storeu_ps(out, sum[0]);
}

// The most that one core can multiply and add in single precision; the time of one dense step's worth of it.
void peak(benchmark::State& state) {
  const bool wide = __builtin_cpu_supports("avx512f");
  const double flops = 2. * (wide ? 16 : 8) * rounds * sums, step = flops_of({{1}});
  float out[16];
  for (auto _ : state)
    for (double done = 0; done < step; done += flops) {
      (wide ? multiply_add_512 : multiply_add_256)(.9999f, 1e-3f, out);
      benchmark::DoNotOptimize(out);
    }
  report(state, {{1}});
}
#endif

}  // namespace

void register_training() {
  for (const auto& [name, shape] : shapes()) {
    const NetworkShape& s = shape;
    for (const Kernels* kernels : available_kernels()) {
      const bool best = kernels == available_kernels().front();
      benchmark::RegisterBenchmark(
          ("step/" + std::string(name) + (best ? "" : std::string("/") + kernels->name)).c_str(),
          [&s, kernels](benchmark::State& state) { ours(state, s, *kernels); });
    }
    for (const auto& [network, architecture] :
         {std::pair("/plain", Architecture::plain), std::pair("/released", Architecture::released)}) {
      NetworkShape other = shape;
      other.architecture = architecture;
      benchmark::RegisterBenchmark(("step/" + std::string(name) + network).c_str(), [other](benchmark::State& state) {
        ours(state, other, *available_kernels().front());
      });
    }
    benchmark::RegisterBenchmark(("step/" + std::string(name) + "/libtorch").c_str(),
                                 [&s](benchmark::State& state) { torchs(state, s); });
    register_pytorch("step/" + std::string(name) + "/pytorch", s.channels, s.text);
  }
#if defined(__x86_64__)
  if (__builtin_cpu_supports("fma")) benchmark::RegisterBenchmark("step/mask/peak", peak);
#endif
}

}  // namespace lgabench
