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
  int epochs = 750;  ///< passes; 0: begin() is all there is
  int batch_size = 10;
  double learning_rate = 1e-3;
  Batches batches = Batches::shuffled;
  bool cosine = false;  ///< the learning rate falls to 0 as half a cosine (Loshchilov and Hutter 2017)
  /// `epochs` at most: ended after the first pass from which on the mean loss of the last 50 passes is less than 1 %
  /// below that of the 50 before.
  bool until_converged = false;
  /// A pass visits as many rows as there are unaltered ones, drawn from all: the steps are those of training without
  /// copies. Else it visits all of them.
  bool equal_steps = true;
};

/// From rows of input to rows of action, with parameters that training moves. One thread at a time. What it does is a
/// function of the seed that it was made with and of the calls: the same calls give the same bytes.
class Learner {
 public:
  virtual ~Learner() = default;

  /// The schedule to train with, from the options of the run and the number of unaltered samples. A learner with its
  /// own schedule overrides this. It cannot change `equal_steps`.
  virtual TrainingOptions schedule(const TrainingOptions& asked, int /*samples*/) const { return asked; }
  /// Called once, before the first backward(), with all samples (at least one), which stay as long as it is trained:
  /// means and frames are found here.
  /// @throws MethodError for samples that it cannot learn from.
  virtual void begin(const Samples&) {}
  /// Actions, rows x the numbers of one, valid until the next call. Labels are not read.
  virtual const std::vector<float>& predict(const Samples& samples) = 0;
  /// Mean loss over `batch`, which names rows of begin()'s samples; keeps the loss's gradients for update().
  virtual double backward(const Samples& samples, const std::vector<int>& batch) = 0;
  /// One step of an optimiser along the gradients of the last backward().
  virtual void update(double learning_rate) = 0;
  /// All trainable numbers, in an order that does not change: what tests compare.
  virtual std::vector<float> parameters() const = 0;
  /// Saves or restores, through the archive, the state that predict() needs and the constructor does not make. A
  /// learner made with the same arguments restores it. False: it cannot be saved. @throws InputError for state that
  /// does not fit.
  virtual bool learned(Archive& /*archive*/) { return false; }
};

}  // namespace lgabench
