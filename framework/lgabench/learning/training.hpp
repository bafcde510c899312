// Training of a learner (docs/protocol.md, section 5).
#pragma once
#include <vector>

#include <lgabench/core/method.hpp>
#include <lgabench/learning/learner.hpp>

namespace lgabench {

/// The samples that pass number `epoch` visits, one batch after the other: a function of the arguments alone.
std::vector<int> batch_order(Batches batches, std::uint64_t seed, int epoch, int samples);

/// begin(), then as many passes as the learner's schedule says, of floor(n / batch_size) batches, or of one batch where
/// n, the rows that a pass visits, is less; they are drawn from all rows. No early stopping: the learner keeps its last
/// parameters. Logs every tenth pass and the last.
/// @throws MethodError if there are no samples or the loss is not finite.
void train(Learner& learner, const Samples& samples, const TrainingOptions& asked, std::uint64_t seed,
           TrainingLog& log);

}  // namespace lgabench
