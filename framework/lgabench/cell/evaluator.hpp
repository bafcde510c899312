// Plays test scenes and judges them: the same for every method.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/abstraction/reading.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/environment.hpp>
#include <lgabench/core/method.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/record/episode.hpp>

namespace lgabench {

/// An actor's action, empty where it says that nothing is left to do, and what the actor says of the input that led to
/// it.
struct Move {
  Move(const Action& does, std::optional<bool> seen = std::nullopt) : action(does), input_seen(seen) {}
  Action action;
  std::optional<bool> input_seen;  // as in Policy::seen_in_training()
};

/// What an actor is given in a scene.
struct Given {
  const Scene& scene;
  const Observation& seen;
  std::optional<Observation> read = {};  // what was read of it, given in its place
  std::optional<Instruction> told = {};  // none: a reference row is told nothing
  int step = 0;                          // of the episode, from 0

  const Observation& observation() const { return read ? *read : seen; }
};

/// Takes note of what an actor is given, step by step.
class Recorder {
 public:
  virtual ~Recorder() = default;
  /// Before the actor acts.
  virtual void given(const Environment& environment, const Given& given) = 0;
  /// After it did, unless it threw.
  virtual void acted() = 0;
};

/// Who plays test scenes: how it acts, what it is told, what it reads, and who takes note of that.
struct Actor {
  using Told = std::function<Instruction(const Scene&)>;

  /// Chooses an action. @throws MethodError where it cannot.
  std::function<Move(const Environment&, const Given&)> choose = nullptr;
  Told told = nullptr;           // null: nothing
  ReadPicture reads = nullptr;   // gives what it is given in place of what is seen; null: that
  Recorder* recorder = nullptr;  // null: nobody takes note

  /// `saw`: gets what the actor was given. @throws as choose()
  Move act(const Environment& environment, const Scene& scene, const Observation& seen, int step = 0,
           Observation* saw = nullptr) const;
};

/// A policy as an actor: it sees the observation and what it is told, nothing else. What it throws, an InputError
/// included, is a MethodError. Holds a reference.
Actor policy_actor(Policy& policy, Actor::Told told, const std::string& plugin_id);

/// A policy that is told the instruction of the scene's command: `instructions`, which it refers to, has one for each
/// of the scenario.
Actor policy_actor(Policy& policy, const std::vector<Instruction>& instructions, const std::string& plugin_id);

/// One episode a scene, in order, each until it is over; `done(n)` after each. A MethodError fails its episode as
/// method_error. @throws EngineError if the engine or the environment fails: then nothing can be said of the method.
std::vector<Episode> evaluate(Environment& environment, const std::vector<TestScene>& scenes, const Actor& actor,
                              const std::function<void(int)>& done);

/// Says of every failed episode what failed (docs/protocol.md, section 5): "reading" where `actor`, given the
/// simulator's names and segments, succeeds in the same picture; "perception" where it succeeds in the same scene seen
/// as it is; "abstraction" where it succeeds there when it reads nothing and is told `truth`, one instruction a
/// command, and where nothing was selected; else "policy". `episodes` is what evaluate() returned of these scenes and
/// this actor, a policy. Nobody takes note. @throws EngineError if the engine fails.
void attribute_failures(Environment& environment, const std::vector<TestScene>& scenes, Actor actor,
                        const std::vector<Instruction>& truth, std::vector<Episode>& episodes);

}  // namespace lgabench
