// Training of a policy network (docs/protocol.md, section 5).
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/method.hpp>
#include <lgabench/learning/network.hpp>

namespace lgabench {

/// shuffled: a pass visits each sample once. drawn: each batch is drawn from all samples, with replacement, as the
/// released code does.
enum class Batches { shuffled, drawn };

/// The defaults are those of the comparison (docs/protocol.md, section 5).
struct TrainingOptions {
  int epochs = 750;
  int batch_size = 10;
  double learning_rate = 1e-3;
  Loss loss = Loss::norm;
  Batches batches = Batches::shuffled;
};

/// The samples that pass number `epoch` visits, one batch after the other: a function of the arguments alone.
std::vector<int> batch_order(Batches batches, std::uint64_t seed, int epoch, int samples);

/// `epochs` passes of floor(rows / batch_size) batches, or of one batch of all rows where there are fewer;
/// Adam; no early stopping: the network keeps its last weights. Logs every tenth pass and the last.
/// @throws MethodError if there are no samples or the loss is not finite.
void train(Network& network, const Samples& samples, const TrainingOptions& options, std::uint64_t seed,
           TrainingLog& log);

}  // namespace lgabench
