// The interface of a method: what a plugin implements. It needs neither LibTorch nor OpenCV.
// The host calls a method from one thread. References are valid during the call, and the caller owns what is returned.
// An exception fails the cell, or the episode if act() threw it, with what() as the reason. An InputError says that an
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

/// One observation with the oracle's action for it. The label is noiseless, also where noise led to the observation. It
/// is empty where the oracle says that nothing is left to do (Services::may_stop).
struct Step {
  Observation observation;
  Action label;
};

/// The oracle's episode for one instruction.
struct Demonstration {
  Instruction instruction;
  std::vector<Step> steps;  // one after the other; one alone but in tasks of several steps
  /// With `Needs::noisy_per_clean`: states that noisy executions of the first step led to, labelled. No episode.
  std::vector<Step> recovery = {};
};

/// Calls call(step) for each step of the episode, then for each recovery step.
template <class Of, class Call>
void for_each_step(Of& demonstration, Call&& call) {
  for (auto* const steps : {&demonstration.steps, &demonstration.recovery})
    for (auto& step : *steps) call(step);
}

/// Id of the instance that the step's label takes or, in a sweep, pushes. It is the visible instance nearest to the
/// action's first place if that lies within two pixels, else the first instance on the straight way to the second
/// place, else the nearest. A place type (`is_place`) is never taken. None where no other instance is in view, or the
/// label is none.
std::optional<std::uint8_t> taken(const Step& step, const ActionSpace& actions);
/// That of the first step.
std::optional<std::uint8_t> taken(const Demonstration& demonstration, const ActionSpace& actions);

/// What a method asks of the data it learns from.
struct Needs {
  /// What training targets are drawn from: the method's own Selection, or the true distribution.
  enum class Targets { selected, truth } targets = Targets::selected;
  /// Noisy rollouts for each clean demonstration (DART, Laskey et al. 2017). The oracle labels the state that a rollout
  /// leads to, which is added. Rollout k of n executes the action with Gaussian noise of sigma = noise_max * k / n,
  /// where 1 is half of a number's range, or half a turn.
  int noisy_per_clean = 0;
  double noise_max = 0;
  /// Whether revise() is called.
  bool revise = false;
  /// Whether observations say which instance throws which shadow (Observation::shadows). repaint() uses that.
  bool shadows = false;
};

/// Where a method reports its training, while learn() runs. Owned by the host.
class TrainingLog {
 public:
  virtual ~TrainingLog() = default;
  /// Call it after each pass over the data, with the passes and optimiser steps so far and the pass's mean loss.
  /// @throws MethodError outside of learn().
  virtual void epoch(int epochs, long long steps, double loss) = 0;
  /// Call it before epoch(), any number of times, with another value of that pass, such as a validation loss. A report
  /// draws a curve for each name, which has 1 to 40 letters, digits and "_".
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
  std::vector<StateNumber> state = {};  // what the numbers of Observation::state mean; none where there are none
  /// Whether an episode of several steps ends when act() returns an empty action: nothing is left to do.
  bool may_stop = false;
};

/// What was learned. It may outlive its Method and the demonstrations. One thread.
class Policy {
 public:
  virtual ~Policy() = default;
  /// Called before each episode.
  virtual void reset() {}
  /// Chooses an action, the only one of an episode but in tasks of several steps. The action must be a function of what
  /// was learned and of the arguments since reset(): the same observations give the same action, whatever was played
  /// before. `observation` comes from a scene that was not demonstrated. `instruction` may hold an utterance that was
  /// not demonstrated, and any Selection, even an empty or the true one.
  /// @returns the numbers of Services::actions. If one is missing, surplus or not finite, the episode fails as
  /// method_error; but an empty action ends it where Services::may_stop says so.
  virtual Action act(const Observation& observation, const Instruction& instruction) = 0;
  /// Whether the last act()'s whole input was, to the byte, one that the policy learned from. None where the policy
  /// does not tell.
  virtual std::optional<bool> seen_in_training() const { return std::nullopt; }
  /// What the last act() read of the scene: the pictures themselves, after all preparation. The host asks after some
  /// episodes, for a report's page; no result depends on the reply. Empty where the policy does not tell.
  virtual Shown shown() const { return {}; }
  /// What was learned, as bytes from which Method::restore() makes a policy that acts alike. A run with --keep-policy
  /// asks for them after the scored episodes, and keeps 64 MiB at most. None where the policy cannot be saved.
  virtual std::optional<std::string> saved() const { return std::nullopt; }
};

/// A method of state abstraction and imitation. For every cell the host makes a new one by its default constructor, in
/// a fresh process. From one thread it calls needs, select for each of the scenario's commands, revise likewise, and
/// learn. Everything that is random must come from Services::seed: the same seed gives the same bytes.
class Method {
 public:
  virtual ~Method() = default;
  /// What the method's demonstrations shall be like. Called first, with the `options` of Services.
  virtual Needs needs(const Json& options) const = 0;
  /// Feature abstraction (paper, section 3.1): which object types and textures of `space` could the command mean? A
  /// method that selects nothing returns a Selection of provenance none. Names outside the space fail the cell. An
  /// empty Selection, or one of which no layout shows anything, is an answer; if targets are drawn from it, the cell
  /// fails as abstraction_empty. The host fills in provenance and cost, from the questions that were asked.
  virtual Selection select(const Command& command, const FeatureSpace& space, Services& services) = 0;
  /// Feature abstraction after the demonstrations: returns the Selection that replaces `selected`, from which the
  /// targets were drawn. Called for each command if needs() asks for it. From then on every Instruction of the command
  /// holds the new Selection, and the run records and measures it. Questions that are asked meanwhile add to its cost.
  /// All else is as in select().
  virtual Selection revise(const Command& /*command*/, const Selection& selected,
                           const std::vector<Demonstration>& /*demonstrations*/, Services& /*services*/) {
    return selected;
  }
  /// Learns from the demonstrations, the cell's number of them for each seen command in turn, in the order of their
  /// scenes. The policy must not refer to them afterwards. @returns never null.
  virtual std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) = 0;
  /// Makes the policy whose saved() gave these bytes. Called in place of all of the above, in another process, with the
  /// same options and seed. @returns never null. @throws InputError for any other bytes.
  virtual std::unique_ptr<Policy> restore(const std::string& /*saved*/, Services& /*services*/) {
    throw MethodError("a policy of this method cannot be restored");
  }
};

}  // namespace lgabench
