#include <lgabench/learning/training.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <lgabench/core/random.hpp>

namespace lgabench {

std::vector<int> batch_order(Batches batches, std::uint64_t seed, int epoch, int samples) {
  if (batches == Batches::shuffled)
    return RandomStream(fmt::format("learning/order/{}/{}", seed, epoch)).permutation(samples);
  RandomStream random(fmt::format("learning/drawn/{}/{}", seed, epoch));
  std::vector<int> drawn(static_cast<std::size_t>(samples));
  for (int& sample : drawn) sample = static_cast<int>(random.below(static_cast<std::uint32_t>(samples)));
  return drawn;
}

namespace {

// Whether the loss has stopped falling; `losses` of each pass so far.
bool converged(const std::vector<double>& losses) {
  constexpr std::ptrdiff_t window = 50;
  constexpr double least_part = .01;
  if (losses.size() < 2 * window) return false;
  const double now = std::accumulate(losses.end() - window, losses.end(), 0.),
               before = std::accumulate(losses.end() - 2 * window, losses.end() - window, 0.);
  return now > (1 - least_part) * before;
}

}  // namespace

void train(Learner& learner, const Samples& samples, const TrainingOptions& asked, std::uint64_t seed,
           TrainingLog& log) {
  if (samples.rows == 0) throw MethodError("training: expected at least one sample, got none");
  learner.begin(samples);
  const TrainingOptions options = learner.schedule(asked, samples.unaltered);
  const int visited = asked.equal_steps ? samples.unaltered : samples.rows;
  const int batch_rows = std::min(options.batch_size, samples.unaltered), batches = visited / batch_rows;
  std::vector<int> batch(static_cast<std::size_t>(batch_rows));
  long long steps = 0;
  std::vector<double> losses;
  const double all_steps = 1. * options.epochs * batches;
  for (int epoch = 1; epoch <= options.epochs; ++epoch) {
    const std::vector<int> order = batch_order(options.batches, seed, epoch, samples.rows);
    double total = 0;
    for (int b = 0; b < batches; ++b) {
      std::copy_n(order.begin() + b * batch_rows, batch_rows, batch.begin());
      total += learner.backward(samples, batch);
      const double part = options.cosine ? (1 + std::cos(pi * static_cast<double>(steps) / all_steps)) / 2 : 1;
      learner.update(part * options.learning_rate);
      ++steps;
    }
    const double mean = total / batches;
    if (!std::isfinite(mean))
      throw MethodError(fmt::format("training diverged: the loss of epoch {} is {}", epoch, mean));
    losses.push_back(mean);
    const bool last = epoch == options.epochs || (options.until_converged && converged(losses));
    if (epoch % 10 == 0 || last) log.epoch(epoch, steps, mean);
    if (last) break;
  }
}

}  // namespace lgabench
