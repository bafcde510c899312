// Plays test scenes and judges them: the same for every method.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/action.hpp>
#include <lgabench/core/environment.hpp>
#include <lgabench/core/method.hpp>

namespace lgabench {

struct Episode {
  std::string arm;
  int index = 0;
  std::uint64_t scene = 0;  // hash
  Failure failure = Failure::none;
  std::optional<ActionVector> action;  // none where the actor gave none
};

/// A line of episodes.jsonl.
Json to_json(const Episode& episode);

/// A test scene and where it stands in its arm.
struct TestScene {
  std::string arm;
  int index = 0;
  Scene scene;
};

/// Chooses the one action of an episode. @throws MethodError where it cannot.
using Actor = std::function<Action(const Environment& environment, const Scene& scene, const Observation& observation)>;

/// A policy as an actor: it sees the observation and the instruction, nothing else. What it throws, an InputError
/// included, is a MethodError. Holds references.
Actor policy_actor(Policy& policy, const Instruction& instruction, const std::string& plugin_id);

/// The rows that a method is measured against: "oracle", or "random_object" (the oracle's rule for a visible object
/// chosen at random, the goal excepted; a random stream per scene). @throws InputError for another id.
Actor reference_actor(const std::string& id);

/// One episode a scene, in order; `done(n)` after each. A MethodError fails its episode as method_error.
/// @throws EngineError if the engine fails: then nothing can be said of the method.
std::vector<Episode> evaluate(Environment& environment, const std::vector<TestScene>& scenes, const Actor& actor,
                              const std::function<void(int)>& done);

/// Every scene failed as abstraction_empty: what an empty Selection earns.
std::vector<Episode> without_abstraction(const std::vector<TestScene>& scenes);

}  // namespace lgabench
