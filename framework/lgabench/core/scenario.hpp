// A scenario: commands, a task, the true distributions, and the scenes it trains and tests on. Read without an engine.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/scene.hpp>
#include <lgabench/core/selection.hpp>

namespace lgabench {

/// One way to ask for the task, and what the scenario's author means by it.
struct ScenarioCommand {
  std::string utterance;
  Selection truth;         // provenance truth
  bool seen = true;        // demonstrated; an unseen command is only tested (paper, Q3)
  std::string arm{};       // the one arm that gives it; "": each that gives commands of its kind
  bool ambiguous = false;  // a reasonable person might mean something else by it: its arm enters no mean
  int wording = 0;  // of a paraphrase of the scenario's command: the level of the axis `paraphrase` that gives it
};

/// What scenes of one kind hold: the environment's own, see EnvironmentType::read_content().
struct SceneContent {
  virtual ~SceneContent() = default;
};

/// How an arm's scenes differ from the control's (perturbations.hpp).
struct Perturbation {
  std::string axis;  // or "all"
  int level = 0;
};

class EnvironmentType;
struct PerturbationAxis;

/// Test scenes of one kind, played by one policy. Arms share their random streams: scene i of each has one layout.
struct Arm {
  std::string id;
  std::shared_ptr<const SceneContent> scenes;     // never null
  bool unseen = false;                            // give the unseen commands instead of the seen ones
  double label_noise = 0, missed_segment = 0;     // how imperfect the textualization is (see textualization.hpp)
  std::optional<Perturbation> perturbation = {};  // of the scenes of the scenario's first arm, its control
  /// The axes that make this difference, in the order in which they do; of `all`, those that the scenario can have.
  /// Axes of plugins live as long as the scenario.
  std::vector<const PerturbationAxis*> axes = {};
  int wording = 0;  // above 0: gives the command in those other words
};

/// Which true distributions hold: the annotations that the paper's authors released with their code, where there are
/// any, or those that the paper's appendix prints.
enum class Truth { released, printed };

/// Axes that plugins add. Whoever runs such a plugin sets what its axis perceives.
using PluginAxes = std::vector<std::shared_ptr<PerturbationAxis>>;

/// A task with its commands, what is shown and what is tested. A value; read from scenarios/ID.json.
struct Scenario {
  std::string id;
  const EnvironmentType* environment = nullptr;  // never null once read
  std::string task;                              // an id of the environment's list
  std::optional<SecondRole> second;              // the task's
  FeatureSpace space;
  std::vector<ScenarioCommand> commands;
  std::string answers_of;  // the scenario whose recorded answers hold for this one; mostly its own id
  /// Files of the data directory's answers/, without their ending: the one that "recorded" means here, and the one that
  /// people are given to edit.
  std::string recorded = "claude", edited = "claude";
  std::shared_ptr<const SceneContent> train;  // never null
  bool as_method_asks = true;  // training targets and second sets come from the Selection, if the method wants that
  std::vector<Arm> tests;
  /// People are asked in the demonstrated scenes and in so many that nobody demonstrated (HumanAnswers::takes()). They
  /// err with that probability. None: nobody is asked.
  struct Questions {
    int scenes = 0;
    double errs = 0;
  };
  std::optional<Questions> questions = {};
  bool may_stop = false;  // whether an actor may say that nothing is left to do (Environment::step())
  PluginAxes axes;        // of plugins, that arms have
  Json json;              // as read, with what the plugins' axes declare: goes into a cell's configuration whole

  /// Command number `i` as a method is given it. @pre 0 <= i < commands.size()
  Command command(int i) const { return {commands[static_cast<std::size_t>(i)].utterance, task, second, may_stop}; }
  std::vector<std::string> utterances() const;  // of all commands
  /// @throws InputError for a test arm that the scenario lacks.
  const Arm& arm(const std::string& name) const;
  /// Commands that scenes of this arm ("train" for training scenes) give in turn, as indices: scene i gives number
  /// i modulo their count. @throws InputError for an arm that the scenario lacks.
  std::vector<int> commands_of(const std::string& name) const;
  /// Whether the arm gives an ambiguous command: its episodes are shown, and enter no mean. @throws InputError as
  /// there.
  bool is_ambiguous(const std::string& name) const;
  /// How many training scenes `demonstrations` of each seen command take: the first ones.
  int training_scenes(int demonstrations) const;
};

/// Reads and checks a scenario's JSON, with its environment; `file` is named in errors. @throws InputError with file
/// and place, also for an environment that is not installed.
Scenario read_scenario(const Json& json, const std::string& file);

/// The scenario named `id` (scenario_files.hpp says where it is looked for). With the printed truth, what the file says
/// under "printed" stands in its place, and "truth" says so. @throws InputError that lists the known ids.
Scenario load_scenario(const std::string& id, Truth truth = Truth::released);

/// Ids of the arms that a scenario's JSON plays: those that "played" names, else all. The other arms still shape the
/// engine's world and the commands, so that outcomes stay the same. @throws InputError
std::vector<std::string> played_arms(const Json& scenario);

/// "released" or "printed". @throws InputError for another word.
Truth read_truth(const std::string& word);

/// Ids of all scenarios that are found, sorted.
std::vector<std::string> scenario_ids();

}  // namespace lgabench
