// Plays test scenes and judges them: the same for every method.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/environment.hpp>
#include <lgabench/core/method.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/record/episode.hpp>

namespace lgabench {

/// An actor's action, and what the actor says of the input that led to it.
struct Move {
  Move(const Action& does, std::optional<bool> seen = std::nullopt) : action(does), input_seen(seen) {}
  Action action;
  std::optional<bool> input_seen;  // as in Policy::seen_in_training()
};

/// Chooses the one action of an episode. @throws MethodError where it cannot.
using Actor = std::function<Move(const Environment& environment, const Scene& scene, const Observation& observation)>;

/// A policy as an actor: it sees the observation and the instruction for the scene's command, nothing else. What it
/// throws, an InputError included, is a MethodError. Holds references. `instructions`: one a command of the scenario.
Actor policy_actor(Policy& policy, const std::vector<Instruction>& instructions, const std::string& plugin_id);

/// Likewise, with the instruction that `told` gives for the scene.
Actor policy_actor(Policy& policy, std::function<Instruction(const Scene&)> told, const std::string& plugin_id);

/// One episode a scene, in order; `done(n)` after each. A MethodError fails its episode as method_error. @throws
/// EngineError if the engine fails: then nothing can be said of the method.
std::vector<Episode> evaluate(Environment& environment, const std::vector<TestScene>& scenes, const Actor& actor,
                              const std::function<void(int)>& done);

/// `actor`, who is given what `reading` makes of an observation. Null: as it is.
Actor reading_actor(Perception reading, Actor actor);

/// Says of every failed episode what failed (docs/protocol.md, section 5): "reading" where `unread`, the same policy
/// given the simulator's names and segments, succeeds in the same picture; "perception" where `actor`, the same policy,
/// succeeds in the same scene seen as it is; "abstraction" where `with_truth`, the policy told the true Selection as
/// well, and unread, does, and where nothing was selected; else "policy". `unread` is null where nothing is read. Other
/// arguments as of evaluate(), `episodes` what it returned.
/// @throws EngineError if the engine fails.
void attribute_failures(Environment& environment, const std::vector<TestScene>& scenes, const Actor& actor,
                        const Actor& with_truth, std::vector<Episode>& episodes, const Actor& unread = {});

}  // namespace lgabench
