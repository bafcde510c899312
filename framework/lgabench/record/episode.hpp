// An episode, and its line of episodes.jsonl.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/action.hpp>
#include <lgabench/core/environment.hpp>
#include <lgabench/core/json.hpp>

namespace lgabench {

/// What a failure may be attributed to, in a fixed order: to perception where the same policy succeeds in the scene
/// seen as it is, to the abstraction where it succeeds with the true mask, else to the policy.
constexpr std::array<const char*, 4> attributions{"abstraction", "policy", "perception", "reading"};

/// What an episode took where an axis gives other commands (PerturbationAxis::other): what the scene's own command
/// means, what the other one means, something else, or nothing.
constexpr std::array<const char*, 4> takings{"own", "other", "third", "none"};

/// How far an episode came whose command says how objects are used (Scene::errand). To say rightly that nothing is left
/// to do is a step like a take.
struct Progress {
  int right = 0, needed = 0;  // steps before the first that was not right, and until all is right: as many on success

  double share() const { return static_cast<double>(right) / needed; }
  /// Whether nothing had to be taken.
  bool nothing_to_take() const { return needed == 1; }
  /// Whether all was taken that had to be, and nothing else before that.
  bool all_taken() const { return right + 1 >= needed; }
};

struct Episode {
  std::string arm;
  int index = 0, command = 0;  // within the arm; of the scenario's commands
  std::string scene;           // its hash, 16 hexadecimal digits
  Failure failure = failure::none;
  Action action{};                     // what was carried out first; empty where the actor gave none
  std::string attribution{};           // of a failure; "" where it is not known
  std::optional<bool> input_seen{};    // Policy::seen_in_training() of the action
  std::string took{};                  // one of takings; "" where no axis gives other commands
  std::optional<int> told{};           // there, the command whose words were given
  std::uint8_t taken = 0;              // StepResult::taken. Not on disk
  std::string error{};                 // of a method_error: what was thrown. Not on disk: its words may hold an address
  std::vector<Action> then{};          // what was carried out after it, in episodes of several steps
  bool done = false;                   // whether the actor then said that nothing is left to do
  std::string pair{};                  // Scene::shared_hash(), 16 digits, where the scene is one of a pair; else ""
  std::optional<Progress> progress{};  // none where the command says no such thing, or no step was made

  bool success() const { return failure == failure::none; }
  int given() const { return told.value_or(command); }  // the command whose words were given
  /// All that the actor did, in order: an empty one, the last, says that nothing is left to do.
  std::vector<Action> actions() const;
  /// The next of these.
  void add(Action next);
};

Json to_json(const Episode& episode);
/// @throws InputError
Episode read_episode(const JsonReader& reader);

}  // namespace lgabench
