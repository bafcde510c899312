// The environment interface, in Gymnasium's words.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/action.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/observation.hpp>
#include <lgabench/core/physics_world.hpp>
#include <lgabench/core/scene.hpp>
#include <lgabench/core/view.hpp>

namespace lgabench {

/// Why an episode did not succeed: one of these words, or one of the environment's (EnvironmentType::failures()).
using Failure = std::string;
namespace failure {
inline constexpr const char* none = "none";
inline constexpr const char* truncated = "truncated";                  // the limit in simulation steps was reached
inline constexpr const char* goes_on = "goes_on";                      // it has not ended: of tasks of several steps
inline constexpr const char* abstraction_empty = "abstraction_empty";  // nothing was selected: not played
inline constexpr const char* method_error = "method_error";            // the method threw, or gave no finite action
}  // namespace failure

/// How far one part of success is from being right, 0 where it is right. The part's name ends with its unit, _m, _deg
/// or _px; a part without a unit is 0 or 1.
struct Gap {
  std::string part;
  double value = 0;
};

/// What an action led to.
struct StepResult {
  Observation observation;  // after the motion, at rest
  bool terminated = false;  // the episode is over, as it is after the one action of most tasks
  bool truncated = false;   // it is over since a limit was reached, in simulation steps or steps: never a success
  bool is_success = false;
  bool recoverable = true;          // false: no further action can make it a success
  Failure failure = failure::none;  // none exactly if is_success; goes_on exactly until the episode is over
  std::uint8_t taken = 0;           // the instance that was moved on purpose; 0: none, or unknown
  std::vector<Gap> gaps;            // the same parts in every scene of a task, all 0 if is_success; empty: unknown
};

/// Limits of success in place of the protocol's, which hold for what is not given. In a task that is judged by an area,
/// the target's centre must be in the area and within `position_m` of its middle.
struct JudgeLimits {
  std::optional<double> position_m{}, angle_deg{};
};

/// What an action led to, under such limits. Narrower limits give fewer successes.
struct Rejudged {
  Failure failure = failure::none;
  std::optional<double> distance_m{};  // seen from above: from where the task asks for it, of the nearest target
};

/// A scene's object as the engine has it.
struct EngineBody {
  Pose pose;
  std::optional<BodyPhysics> physics;  // none: the engine cannot tell
};

/// An environment on an engine. One thread at a time. Every call but reset() needs a reset() before it.
class Environment {
 public:
  virtual ~Environment() = default;

  /// What the numbers of the environment's actions mean; does not change.
  virtual const ActionSpace& action_space() const = 0;

  /// TaskInfo::most_steps, as make_environment() knows it: no environment says it itself.
  virtual int most_steps() const { return 1; }

  /// Builds the scene anew. Pure: the same scene gives the same bytes, whatever was played before.
  /// @throws EngineError if the engine fails, InputError for an unknown object type or texture.
  virtual Observation reset(const Scene& scene) = 0;

  /// Returns what is seen in that view, in which observe() and step() then see until the next reset(). The oracle reads
  /// its places off that picture as if it were the usual one: a moved camera leads the oracle astray as far as the
  /// picture moved. Actions are carried out as ever. @throws InputError unless EnvironmentType::has_views().
  virtual Observation look(const View& /*view*/) { throw InputError("environment: it has one view only"); }

  /// Sets whether observations have Observation::shadows from now on. Pictures stay the same. @throws InputError where
  /// shadows are asked for and the environment has none.
  virtual void show_shadows(bool on) {
    if (on) throw InputError("environment: it does not report shadows");
  }

  /// Carries out the action until all is at rest. May be called again: the next action starts from the state reached
  /// (demonstrations with injected noise need it), and success is judged against the scene's beginning. In tasks of
  /// several steps it is called until the episode is over. An empty action says that nothing is left to do; it comes
  /// only where the scenario says may_stop.
  /// @throws MethodError for an action that is not executable(), EngineError if the engine fails.
  virtual StepResult step(const Action& action) = 0;

  /// The scene's objects as the engine has them now, in their order; checks of perturbed bodies compare them. Empty
  /// where the environment does not say: such a perturbation then counts as without effect.
  virtual std::vector<EngineBody> bodies() const { return {}; }

  /// What is seen in the present state. An onlooker at the engine may call this while step() is under way.
  virtual Observation observe() = 0;

  /// The oracle's action in the present state, for the scene's target; empty as in step().
  virtual Action expert_action() const = 0;

  /// The action that the oracle would choose if `instance_id` were the target.
  virtual Action expert_action_for(std::uint8_t instance_id) const = 0;

  /// Judges once more what the last step() led to. Without limits, the failure is that step's. @throws InputError where
  /// an environment has no limits to change.
  virtual Rejudged judged_again(const JudgeLimits& /*limits*/) const {
    throw InputError("environment: its judge has no limits to change");
  }
};

}  // namespace lgabench
