// Behaviour cloning, as every shipped method does it. Methods differ in what the learner sees and in who selects.
#pragma once
#include <memory>
#include <vector>

#include <lgabench/core/method.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/learning/featurizer.hpp>
#include <lgabench/learning/learner.hpp>

/// The options that every cloning method has, for its descriptor: LGABENCH_METHOD(..., "{" LGABENCH_TRAINING_OPTIONS
/// "}").
#define LGABENCH_TRAINING_OPTIONS                                                                        \
  R"("epochs": {"framework": true, "default": 750, "min": 1, "words": ["converged"], )"                  \
  R"("help": "passes over the training data; converged: until the mean loss of 50 passes is less than )" \
  R"(1 % below that of the 50 before, 750 at most",)"                                                    \
  R"("source": "paper, appendix"},)"                                                                     \
  R"("batch_size": {"framework": true, "default": 10, "min": 1, "help": "samples per step",)"            \
  R"("source": "docs/protocol.md, section 5"},)"                                                         \
  R"("learning_rate": {"framework": true, "default": 0.001, "min": 0, "help": "of Adam",)"               \
  R"("source": "docs/protocol.md, section 5"},)"                                                         \
  R"("batches": {"framework": true, "default": "drawn", "values": ["drawn", "shuffled"],)"               \
  R"("help": "each batch drawn with replacement, or each sample once per pass",)"                        \
  R"("source": "drawn: released code"})"

/// Options of a method that trains the paper's network.
#define LGABENCH_CLONING_OPTIONS                                                                                  \
  LGABENCH_TRAINING_OPTIONS                                                                                       \
  R"(,"loss": {"framework": true, "default": "norm", "values": ["norm", "squared"],)"                             \
  R"("help": "L2 norm of the error, or its square", "source": "norm: released code; squared: paper"},)"           \
  R"("network": {"framework": true, "default": "text", "values": ["text", "released", "plain", "spot"],)"         \
  R"("help": "batch normalisation before each ReLU, after it, or none; spot: none, and a linear layer of 1000, )" \
  R"(with an action's numbers scaled to their bounds",)"                                                          \
  R"("source": "text: paper, appendix; released: released code; spot: the notebook released for section 6"})"

/// The option of a method that sees the goal mask alone, or the picture beside it.
#define LGABENCH_PICTURE_OPTION                                                     \
  R"("picture": {"framework": true, "default": "none", "values": ["none", "rgb"],)" \
  R"("help": "seen beside the goal mask", "source": "rgb: paper, appendix"})"

/// The option of a method that makes copies().
#define LGABENCH_COPIES_OPTION                                        \
  R"("copy_steps": {"default": "equal", "values": ["equal", "all"],)" \
  R"("help": "optimiser steps: as many as without copies, or 1 + copies times as many", "source": "ours"})"

/// Options of a method whose policy sees a goal mask.
#define LGABENCH_MASK_OPTIONS LGABENCH_MASK_OPTIONS_WITH("", R"(, "needs": {"signed": {"policy": ["regression"]}})", "")

/// Options of a method that sees a goal mask with some of its options alone. The arguments are further members of
/// `instances`, `mask` and `policy`, each ", " and JSON or "".
#define LGABENCH_MASK_OPTIONS_WITH(of_instances, of_mask, of_policy)                                              \
  R"("instances": {"framework": true, "default": "all", "values": ["all", "first"], )"                            \
  R"("help": "if several visible instances match one role: all are in the mask, or the first, row by row",)"      \
  R"("source": "all: docs/protocol.md; first: paper, section 3.2, 'an unambiguous abstract state'")" of_instances \
  R"(}, "mask": {"framework": true, "default": "binary", "values": ["binary", "signed"], )"                       \
  R"("help": "1 on all that matters; signed: -1 on what is to be avoided and is not the target",)"                \
  R"("source": "signed: paper, footnote on cost maps")" of_mask R"(}, )" LGABENCH_POLICY_OPTION_(                 \
      R"("regression", "centroid", "heat_map", "point")",                                                         \
      "centroid: no training, the middle of the target. These two see target and avoid set apart, and ignore "    \
      "options of the training. point: no policy is learned, what the Selection keeps is taken as it stands",     \
      of_policy)

/// In place of LGABENCH_MASK_OPTIONS, for a method without a goal mask.
#define LGABENCH_NO_MASK_OPTIONS                                                                        \
  LGABENCH_POLICY_OPTION_(R"("regression", "heat_map")",                                                \
                          "it ignores options of the training. centroid needs a goal mask, which this " \
                          "method lacks",                                                               \
                          "")

#define LGABENCH_POLICY_OPTION_(values, help, more)                                           \
  R"("policy": {"framework": true, "default": "regression", "values": [)" values              \
  R"(], "help": "regression: the network; heat_map: one that keeps spatial positions; )" help \
  R"(", "source": "regression: paper; the others: not the paper's")" more "}"

namespace lgabench {

/// A subclass overrides select(). It overrides inputs() if its network sees more or other things than the goal mask,
/// learner() if it has a network of its own, and needs() if it asks for more than demonstrations of its own Selection's
/// targets. One thread.
class CloningMethod : public Method {
 public:
  Needs needs(const Json&) const override { return {}; }
  /// Trains the learner on every step of every demonstration. The policy tells whether an input is, to the byte, one of
  /// training.
  /// @throws InputError for inputs() that the option `policy` cannot use, and for a text without a sentence embedding
  /// if the encoder's weights are missing.
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override;
  /// Restores the learner and the feature space. A policy whose inputs() depend on other things that were selected or
  /// demonstrated was never saved.
  std::unique_ptr<Policy> restore(const std::string& saved, Services& services) override;

 protected:
  /// What the learner sees: by default the goal mask, and the picture where the option `picture` says so. `options` are
  /// those of Services.
  virtual PolicyInputs inputs(const Json& options) const;
  /// How often each step is copied for augment(), by default 0. The learner learns from the unaltered steps as well.
  /// The number of optimiser steps stays the same (see LGABENCH_COPIES_OPTION), and so does the usual picture, which is
  /// that of the unaltered steps.
  virtual int copies(const Json& options) const;
  /// Alters a copy of a step, for example by repaint() of its observation. Its goal mask is made of `selection`. Copies
  /// count from 0, and `stream` is the copy's own, named by Services::seed.
  virtual void augment(Step& step, const Selection& selection, int copy, RandomStream& stream) const;
  /// The rows that the learner is trained on. `clean` has a row for each step of each demonstration, in their order,
  /// and behind them the copies. By default these are all; a subclass may add others.
  virtual Samples training_rows(Samples clean, const Services& services) const;
  /// The learner for rows of that shape, by default the one that the option `policy` names. It may outlive the method.
  virtual std::unique_ptr<Learner> learner(const SampleShape& shape, const Services& services) const;
};

}  // namespace lgabench
