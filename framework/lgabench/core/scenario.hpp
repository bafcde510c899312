// A scenario: commands, a task, the true distributions, and the scenes it trains and tests on. Read without an engine.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/scene.hpp>
#include <lgabench/core/selection.hpp>

namespace lgabench {

/// What a method is told of the task: the words, and the kind of motion that is wanted.
struct Command {
  std::string utterance;
  Task task = Task::pick_and_place;
};

/// One way to ask for the task, and what the scenario's author means by it.
struct ScenarioCommand {
  std::string utterance;
  Selection truth;   // provenance truth
  bool seen = true;  // demonstrated; an unseen command is only tested (paper, Q3)
};

/// What scenes of one kind hold. Targets and obstacles are drawn from the command's truth where nothing else is said.
struct SceneContent {
  std::optional<FeatureSet> target, avoid;
  bool as_method_asks = false;  // training alone: targets and obstacles from the Selection, if the method wants that
  std::pair<int, int> distractors{1, 2};  // fewest and most, all numbers with equal odds
  bool outside_all_commands = false;      // distractors stay out of what any command means, not the given one's alone
  bool hard = false;           // a distractor shares the target's type or its texture, and still is no target
  bool later_letters = false;  // "the one that comes earliest": a distractor may be a later letter
  /// All of these types stand there, once each, in any texture; the command's truth says which are right (targets; for
  /// sweep, obstacles), the others are distractors.
  std::vector<std::string> choice;
  /// Sweep: how far from the target, along y, what bars a side alone stands; each with equal odds, one a scene.
  std::vector<double> barrier_distances_m{.21};
};

/// Test scenes of one kind, played by one policy. Arms share their random streams: scene i of each has one layout.
struct Arm {
  std::string id;
  SceneContent scenes;
  bool unseen = false;                         // give the unseen commands instead of the seen ones
  double label_noise = 0, missed_segment = 0;  // how imperfect the textualization is (see textualization.hpp)
};

/// Whose true distributions: the annotations that the paper's authors released with their code where there are any, or
/// those that the paper's appendix prints.
enum class Truth { released, printed };

/// A task with its commands, what is shown and what is tested. A value; read from scenarios/ID.json.
struct Scenario {
  std::string id, environment;
  Task task = Task::pick_and_place;
  double angle_deg = 0;  // rotate only: counter-clockwise seen from above, negative where it is clockwise
  FeatureSpace space;
  std::vector<ScenarioCommand> commands;
  std::string answers_of;  // the scenario whose recorded answers hold for this one; mostly its own id
  /// Files of the data directory's answers/, without their ending: whose answers "recorded" means here, and which of
  /// them people are given to edit.
  std::string recorded = "claude", edited = "claude";
  std::optional<FeatureSet> never_distractor;  // test distractors stay out of it, beyond the true distribution
  SceneContent train;
  std::vector<Arm> tests;
  Json json;  // as read: goes into a cell's configuration whole

  /// Command number `i` as a method is given it. @pre 0 <= i < commands.size()
  Command command(int i) const { return {commands[static_cast<std::size_t>(i)].utterance, task}; }
  std::vector<std::string> utterances() const;  // of all commands
  /// @throws InputError for a test arm that the scenario lacks.
  const Arm& arm(const std::string& name) const;
  /// Commands that scenes of this arm ("train" for training scenes) give in turn, as indices: scene i gives number
  /// i modulo their count. @throws InputError for an arm that the scenario lacks.
  std::vector<int> commands_of(const std::string& name) const;
  /// How many training scenes `demonstrations` of each seen command take: the first ones.
  int training_scenes(int demonstrations) const;
};

/// Reads and checks a scenario's JSON; `file` is named in errors. @throws InputError with file and place.
Scenario read_scenario(const Json& json, const std::string& file);

/// The scenario named `id` (scenario_files.hpp says where it is looked for). With the printed truth, what the file says
/// under "printed" stands in its place, and "truth" says so. @throws InputError that lists the known ids.
Scenario load_scenario(const std::string& id, Truth truth = Truth::released);

/// "released" or "printed". @throws InputError for another word.
Truth read_truth(const std::string& word);

/// Ids of all scenarios that are found, sorted.
std::vector<std::string> scenario_ids();

}  // namespace lgabench
