#include <lgabench/learning/training.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <lgabench/core/random.hpp>

namespace lgabench {
namespace {

// Copies row `from` of `source` over row `to` of `target`.
void copy_row(const std::vector<float>& source, int from, std::vector<float>& target, int to, int target_rows) {
  const auto width = static_cast<std::ptrdiff_t>(target.size()) / target_rows;
  std::copy_n(source.begin() + from * width, width, target.begin() + to * width);
}

}  // namespace

std::vector<int> batch_order(std::uint64_t seed, int epoch, int samples) {
  return RandomStream(fmt::format("learning/order/{}/{}", seed, epoch)).permutation(samples);
}

void train(Network& network, const NetworkShape& shape, const Samples& samples, const TrainingOptions& options,
           std::uint64_t seed, TrainingLog& log) {
  if (samples.rows == 0) throw MethodError("training: expected at least one sample, got none");
  const int batch_rows = std::min(options.batch_size, samples.rows), batches = samples.rows / batch_rows;
  Samples batch(shape, batch_rows);
  Adam adam(network.size(), options.learning_rate);
  long long steps = 0;
  for (int epoch = 1; epoch <= options.epochs; ++epoch) {
    const std::vector<int> order = batch_order(seed, epoch, samples.rows);
    double total = 0;
    for (int b = 0; b < batches; ++b) {
      for (int row = 0; row < batch_rows; ++row) {
        const int from = order[static_cast<std::size_t>(b * batch_rows + row)];
        for (std::size_t t = 0; t < samples.pictures.size(); ++t)
          copy_row(samples.pictures[t], from, batch.pictures[t], row, batch_rows);
        copy_row(samples.text, from, batch.text, row, batch_rows);
        copy_row(samples.labels, from, batch.labels, row, batch_rows);
      }
      total += network.backward(batch, options.loss);
      adam.step(network.parameters(), network.gradients());
      ++steps;
    }
    const double mean = total / batches;
    if (!std::isfinite(mean)) throw MethodError(fmt::format("training: the loss of epoch {} is {}", epoch, mean));
    if (epoch % 10 == 0 || epoch == options.epochs) log.epoch(epoch, steps, mean);
  }
}

}  // namespace lgabench
