// The interface of what is trained: a policy's network. docs/extending.md walks through one.
#pragma once
#include <vector>

#include <lgabench/learning/archive.hpp>
#include <lgabench/learning/samples.hpp>

namespace lgabench {

/// shuffled: a pass visits each sample once. drawn: each batch is drawn from all samples, with replacement, as the
/// released code does.
enum class Batches { shuffled, drawn };

/// How long and how fast to train; the defaults are those of the comparison (docs/protocol.md, section 5).
struct TrainingOptions {
  int epochs = 750;  ///< passes over the samples; 0: begin() is the whole training
  int batch_size = 10;
  double learning_rate = 1e-3;
  Batches batches = Batches::shuffled;
  bool cosine = false;  ///< the learning rate falls to 0 as half a cosine (Loshchilov and Hutter 2017)
  /// Whether training ends early, with the first pass at which the mean loss of the last 50 passes is less than 1 %
  /// below that of the 50 before.
  bool until_converged = false;
  /// If true, a pass visits as many rows as there are unaltered ones, drawn from all: there are as many steps as
  /// without copies. If false, a pass visits all rows.
  bool equal_steps = true;
};

/// Maps rows of input to rows of action, by parameters that training moves. One thread at a time. A learner made with
/// the same seed must give the same bytes after the same calls.
class Learner {
 public:
  virtual ~Learner() = default;

  /// The schedule to train with, from the options of the run and the number of unaltered samples. A learner with its
  /// own schedule overrides this. It cannot change `equal_steps`.
  virtual TrainingOptions schedule(const TrainingOptions& asked, int /*samples*/) const { return asked; }
  /// Called once, before the first backward(), with all samples (at least one). They stay valid throughout training. A
  /// learner computes means and frames here.
  /// @throws MethodError for samples that it cannot learn from.
  virtual void begin(const Samples&) {}
  /// Returns the actions, rows x numbers of an action, valid until the next call. It does not read labels.
  virtual const std::vector<float>& predict(const Samples& samples) = 0;
  /// Returns the mean loss over `batch`, which names rows of begin()'s samples, and keeps its gradients for update().
  virtual double backward(const Samples& samples, const std::vector<int>& batch) = 0;
  /// Takes one step of an optimiser along the gradients of the last backward().
  virtual void update(double learning_rate) = 0;
  /// All trainable numbers, in an order that does not change: what tests compare.
  virtual std::vector<float> parameters() const = 0;
  /// Saves or restores, through the archive, the state that predict() needs and the constructor does not make. A
  /// learner made with the same arguments restores it. @returns false if the learner cannot be saved. @throws
  /// InputError for state that does not fit.
  virtual bool learned(Archive& /*archive*/) { return false; }
  /// What the trained network makes of each row before the layer that makes an action, rows x as many numbers, or
  /// none: a policy that may say that nothing is left to do learns to say it by them. It does not read labels.
  virtual std::vector<float> features(const Samples& /*samples*/) { return {}; }
};

}  // namespace lgabench
