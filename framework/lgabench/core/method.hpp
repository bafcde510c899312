// The interface of a method: what a plugin implements. No LibTorch, no OpenCV here.
// The host calls it from one thread; references are valid during the call; what it returns is owned by the caller. What
// it throws fails the cell, or the episode if act() threw it, with what() as the reason; an InputError says that an
// option or a file is wrong, not the method.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/action.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/language_model.hpp>
#include <lgabench/core/observation.hpp>
#include <lgabench/core/shown.hpp>

namespace lgabench {

/// What a policy is conditioned on: the command's words and the Selection made for them.
struct Instruction {
  std::string utterance;
  Selection selection;
};

/// One observation with the oracle's action for it. The label is noiseless, also where noise led to the observation.
struct Step {
  Observation observation;
  Action label;
};

/// The oracle's episode for one instruction: with `Needs::noisy_per_clean` the recovery steps follow the first.
struct Demonstration {
  Instruction instruction;
  std::vector<Step> steps;
};

/// Id of the instance that the first step's label takes or, in a sweep, pushes: the visible one within two pixels of
/// the action's first place that is nearest to it, else the first one met on the straight way to the second place, else
/// the nearest. Place types (`is_place`) never are. None where nothing else is in view.
std::optional<std::uint8_t> taken(const Demonstration& demonstration, const ActionSpace& actions);

/// What a method asks of the data it learns from.
struct Needs {
  /// Training targets are drawn from the method's own Selection, or from the true distribution.
  enum class Targets { selected, truth } targets = Targets::selected;
  /// DART (Laskey et al. 2017): noisy rollouts for each clean demonstration; the state each leads to is labelled by
  /// the oracle and added. Rollout k of n executes the action with sigma = noise_max * k / n.
  int noisy_per_clean = 0;
  double noise_max = 0;
  /// revise() is called.
  bool revise = false;
  /// Observations say which instance throws which shadow (Observation::shadows): for repaint().
  bool shadows = false;
};

/// Where a method reports its training, while learn() runs. Owned by the host.
class TrainingLog {
 public:
  virtual ~TrainingLog() = default;
  /// After each pass over the data: passes so far, optimiser steps so far, mean loss of the pass. @throws MethodError
  /// outside of learn().
  virtual void epoch(int epochs, long long steps, double loss) = 0;
  /// Before it, any number of times: another value of that pass, as a validation loss. A report draws a curve of each
  /// name: 1 to 40 letters, digits and "_".
  virtual void curve(const std::string& name, double value) { static_cast<void>(name), static_cast<void>(value); }
};

/// What the host lends to a method for the length of a call.
struct Services {
  LanguageModel& lm;
  HumanAnswers& human;  // answers as the descriptor asks, see LGABENCH_METHOD_ASKING; else throws MethodError
  const Json& options;  // an object with every option of the descriptor, defaults filled in
  std::uint64_t seed;   // governs initial weights and batch order
  TrainingLog& log;
  const ActionSpace& actions;  // what an action's numbers mean
  /// A command's true distribution, for a method whose descriptor asks for the truth; for others it throws MethodError.
  std::function<Selection(const Command&)> truth = {};
  /// A directory for pictures and curves of the method's own: plain files in it are kept with the cell (files/). It is
  /// read when the last scored episode is over.
  std::filesystem::path files = {};
  /// In revise(): whether the demonstrations' targets are drawn from the true distribution, as their method or the
  /// scenario wants it. Otherwise they show what was selected, and tell nothing more of the command.
  bool shows_truth = false;
};

/// What was learned. It may outlive its Method and the demonstrations. One thread.
class Policy {
 public:
  virtual ~Policy() = default;
  /// Called before each episode.
  virtual void reset() {}
  /// The one action of an episode: a function of its arguments and of what was learned, so that the same scene gives
  /// the same action whatever was played before. `observation` comes from a scene that was not demonstrated;
  /// `instruction` may hold an utterance that was not, and any Selection, an empty one or the true one included.
  /// @returns the numbers of Services::actions. Others, or one that is not finite: the episode fails as method_error.
  virtual Action act(const Observation& observation, const Instruction& instruction) = 0;
  /// Whether all that the last act() made its action of was, to the byte, an input that the policy learned from. None
  /// where it does not tell.
  virtual std::optional<bool> seen_in_training() const { return std::nullopt; }
  /// What the last act() read of the scene: the pictures themselves, as they were after all that prepares them. Asked
  /// after some episodes, for a report's page; no result depends on it. Nothing where the policy does not tell.
  virtual Shown shown() const { return {}; }
  /// What was learned, as bytes of which Method::restore() makes a policy that acts alike: asked of a run with
  /// --keep-policy, after the scored episodes. None where it cannot be saved. 64 MiB at most are kept.
  virtual std::optional<std::string> saved() const { return std::nullopt; }
};

/// A method of state abstraction and imitation. Made anew, in a fresh process, for every cell by its default
/// constructor; called in the order needs, select for each of the scenario's commands, revise likewise, learn. One
/// thread. Everything that is random comes from Services::seed: the same seed gives the same bytes.
class Method {
 public:
  virtual ~Method() = default;
  /// What its demonstrations shall be like. `options` as in Services. Called first.
  virtual Needs needs(const Json& options) const = 0;
  /// Feature abstraction (paper, section 3.1): which object types and textures of `space` could the command mean? A
  /// method that selects nothing returns a Selection of provenance none. Names outside the space fail the cell; an
  /// empty Selection, or one of which no layout shows anything, is an answer, and fails it as abstraction_empty if
  /// targets are drawn from it. A run says itself, from what was asked, where it comes from and what it cost.
  virtual Selection select(const Command& command, const FeatureSpace& space, Services& services) = 0;
  /// Feature abstraction with what was shown: another Selection for the command in place of what select() returned,
  /// from which the targets were drawn. Called for each command once the demonstrations are there, where needs() asks
  /// for it. From then on it is the command's in every Instruction, and what the run records and measures; what is
  /// asked meanwhile is added to its cost. Otherwise as select().
  virtual Selection revise(const Command& /*command*/, const Selection& selected,
                           const std::vector<Demonstration>& /*demonstrations*/, Services& /*services*/) {
    return selected;
  }
  /// Learns from the demonstrations, the cell's number of them for each seen command in turn, in the order of their
  /// scenes. The policy must not refer to them afterwards. @returns never null.
  virtual std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) = 0;
  /// In place of all of the above, in another process with the same options and seed: the policy whose saved() gave
  /// these bytes. @returns never null. @throws InputError for bytes that it did not give.
  virtual std::unique_ptr<Policy> restore(const std::string& /*saved*/, Services& /*services*/) {
    throw MethodError("a policy of this method cannot be restored");
  }
};

}  // namespace lgabench
