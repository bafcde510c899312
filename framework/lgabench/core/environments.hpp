// The installed environments: what the framework asks of an environment beside playing scenes (environment.hpp).
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <lgabench/core/action.hpp>
#include <lgabench/core/environment.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/physics_world.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/core/scenario.hpp>

namespace lgabench {

/// A task of an environment, by its words.
struct TaskInfo {
  std::string id;
  std::vector<std::string> layouts;   // how its objects may be placed
  std::optional<SecondRole> second;   // the set of objects that its commands speak of beside the target
  std::vector<std::string> failures;  // the task's own words, beside those that all tasks of the environment share
  std::string example;                // a shipped scenario: what checks play where any scenario of the task will do
  /// Actions of an episode. More than one: steps follow each other until StepResult says that the episode is over, or
  /// there were so many, which is a failure.
  int most_steps = 1;
};

/// All that a scene depends on (docs/protocol.md, section 3): not engine, method, thread or host.
struct SceneRequest {
  std::string layout;  // one of the task's
  std::string split;   // train, dev or test
  std::string arm;     // of the scenario's tests, or "train" for training scenes
  std::uint64_t seed = 0;
  /// Where the scenario leaves training targets and second sets to the method, a Selection for each command, of which
  /// only the distributions count. Empty: the truth.
  std::vector<Selection> selections = {};
  /// The training seed of test scenes that belong to one seed: part of their random streams. None: all seeds share
  /// them.
  std::optional<std::uint64_t> training_seed = {};
};

/// The part of a random stream's name that tells training seeds with scenes of their own apart; "" where all share
/// them.
std::string own_stream(std::optional<std::uint64_t> training_seed);

/// The same of an observation after so many steps: "" at the scene's beginning.
std::string later_stream(int step);

/// How far one action lies from another that should do the same.
struct ActionDistance {
  double begin_m = 0, end_m = 0;  // between the places where the actions begin, and where they end
  double turn_rad = 0;            // between their turns, where the task asks for one
};

/// An observation with the errors that a perception makes, drawn from the stream.
using Perceive = std::function<Observation(Observation, RandomStream)>;

/// A distribution of which a layout can show nothing.
class NothingToShow : public InputError {
 public:
  using InputError::InputError;
  ~NothingToShow() override;
};

/// What a contact sheet shows of an environment's objects, each alone in the middle of a scene: every type of a feature
/// space in one texture, and every texture of one on one type.
struct Showcase {
  std::string types_of, texture;  // the feature space's id; the texture
  std::string textures_of, type;
  Vec2 position_m;
};

/// What stands for an engine's id in cells of an environment that has no engine plugin.
inline constexpr const char* own_engine = "own";

/// A kind of environment: one constant object for as long as the program runs. Any thread may call it, but for draw().
class EnvironmentType {
 public:
  virtual ~EnvironmentType() = default;

  virtual const std::string& id() const = 0;
  /// The environment's tasks, in the order in which tables and checks name them.
  virtual const std::vector<TaskInfo>& tasks() const = 0;
  /// Feature spaces whose objects its scenes can show, the usual one first.
  virtual const std::vector<std::string>& spaces() const = 0;
  /// None, as by default, where contact sheets show its scenes alone.
  virtual std::optional<Showcase> showcase() const { return std::nullopt; }
  /// Every word that step() may give for a failure, in the order in which reports list them: but the framework's own,
  /// and those that only tasks of several steps have (TaskInfo::failures), which reports list where they were found.
  virtual const std::vector<std::string>& failures() const = 0;

  /// What the numbers of the environment's actions mean.
  virtual const ActionSpace& action_space() const = 0;
  /// The same as methods of that task are told it: with the task's stations, if it has any.
  virtual const ActionSpace& action_space_of(const TaskInfo& /*task*/) const { return action_space(); }
  /// What the numbers of Observation::state mean in that task; none, as by default, where it has no state.
  virtual const std::vector<StateNumber>& state_of(const TaskInfo& task) const;
  /// The size of each observation.
  virtual PictureSize picture_size() const = 0;
  /// How many instances an observation of that task may have, whatever the scenario.
  virtual int most_instances(const TaskInfo& task) const = 0;
  /// Where the camera shows a point of the world, in metres: x its column, y its row, in pixels, 0 at the picture's
  /// corner; also outside of the picture.
  virtual Vec2 in_picture(Vec3 point_m) const = 0;

  /// Further members of a scenario's file, which the environment reads: beside those of scenario.hpp and, in "train"
  /// and each of "tests", beside those of Arm.
  virtual std::vector<std::string> scenario_members(const TaskInfo& task) const = 0;
  virtual std::vector<std::string> scene_members(const TaskInfo& task) const = 0;
  /// Reads what scenes of one kind hold. `file` is the whole scenario; `scenes` is its "train", null where it has none,
  /// or one of its "tests". `scenario` is complete but for these. @throws InputError with file and place.
  virtual std::shared_ptr<const SceneContent> read_content(const Scenario& scenario, const JsonReader& file,
                                                           const JsonReader* scenes, bool training) const = 0;

  /// Scene number `index`. @throws InputError where layout, split or arm is unknown; NothingToShow where a Selection or
  /// the truth holds no target, or nothing of the second set, that the layout can show.
  virtual Scene sample(const Scenario& scenario, const SceneRequest& request, int index) const = 0;
  /// What that request's training scenes show of what the scenario's commands mean: for each command a list of [object
  /// type, texture]. Null where nothing is left out.
  virtual Json shown_members(const Scenario& /*scenario*/, const SceneRequest& /*request*/) const { return nullptr; }
  /// How scenes of that kind are perceived, beside the noise that every environment's arms may ask for (scenario.hpp).
  /// Null where nothing errs, as by default.
  virtual Perceive perception(const SceneContent& /*scenes*/) const { return nullptr; }
  /// The distance of two actions in that task. None where an action's poses alone do not decide it, as by default.
  virtual std::optional<ActionDistance> distance(const TaskInfo& /*task*/, const Action& /*one*/,
                                                 const Action& /*other*/) const {
    return std::nullopt;
  }
  /// The object type of the place to bring things to, which no command means; "" where there is none.
  virtual std::string goal_type() const { return ""; }
  /// The task's layouts that can show the scenario's scenes, by default all.
  virtual std::vector<std::string> layouts_of(const Scenario& scenario) const;
  /// How many more distractors test scenes of the scenario's first arm have room for: 0 unless an environment says
  /// otherwise.
  virtual int room_for_distractors(const Scenario& /*scenario*/) const { return 0; }
  /// A test arm's scene with so many more distractors, uniform ones or near misses of the target. One stream gives
  /// those of a smaller count first, then others. The control's objects stay where they are. @throws NothingToShow
  /// where none fits.
  virtual Scene with_distractors(const Scenario& scenario, Scene scene, int count, bool near_miss,
                                 RandomStream random) const;
  /// The scene with everything that can be brought somewhere, or swept, scaled by that factor.
  virtual Scene resized(Scene scene, double scale) const;
  /// The scene with the largest target for which room is left, by 5 mm: that of the greatest fitting one of `scales`,
  /// which grow, if any.
  virtual Scene with_larger_target(Scene scene, const std::vector<double>& scales) const;
  /// What is seen at the scene's beginning, without an engine. One thread at a time.
  virtual Observation draw(const Scene& scene, const View& view) const = 0;
  Observation draw(const Scene& scene) const { return draw(scene, View()); }
  /// Whether draw() and Environment::look() show other views than the usual one.
  virtual bool has_views() const { return false; }
  /// How an engine's world for the scenario differs from that of most scenarios, "" where it does not: demonstrations
  /// depend on it.
  virtual std::string world_of(const Scenario& /*scenario*/) const { return ""; }
  /// Whether an engine plugin moves its bodies, as by default. An environment without one is made with none.
  virtual bool has_engine() const { return true; }
  /// An environment on that engine, for scenes of that scenario; `engine` is null exactly without has_engine().
  /// @throws EngineError if the engine fails.
  virtual std::unique_ptr<Environment> make(std::unique_ptr<PhysicsWorld> engine, const Scenario& scenario) const = 0;
};

/// The environment named `id`: lgabench's own, the shared library lgabench_env_ID beside its others, or one that was
/// added. It is loaded when it is first asked for. Any thread. @throws InputError for one that is not known;
/// PluginError for one that cannot be loaded.
const EnvironmentType& find_environment(const std::string& id);
/// The same; nullptr where find_environment() throws.
const EnvironmentType* environment_if_there(const std::string& id);

/// Loads an environment. What it returns lives as long as the program.
using LoadEnvironment = std::function<const EnvironmentType*()>;
/// Makes an environment known that is not lgabench's own: a plugin's. Once an id is known, the later `load` is ignored
/// where `sha256` is the same. Any thread. @throws InputError for an id that is taken.
void add_environment(const std::string& id, const std::string& sha256, LoadEnvironment load);
/// Sets what find_environment() calls before it gives up on an id. It may add environments, and returns why a file of
/// that name was refused, or "". One thread, before main().
void look_for_environments(std::function<std::string(const std::string& id)> look);

/// Ids of lgabench's own environments, sorted. Those of plugins are not among them: installing one changes no run.
std::vector<std::string> environment_ids();
/// lgabench's own environment that has the task. @throws InputError that lists the known tasks.
const EnvironmentType& environment_with_task(const std::string& id);

/// Tasks of lgabench's own environments.
std::vector<TaskInfo> installed_tasks();
/// Their ids.
std::vector<std::string> installed_task_ids();
/// Layouts of all tasks, each once.
std::vector<std::string> installed_layouts();
/// Words for a failure, in a report's order: of lgabench's own environments, the framework's, then those of `found`
/// that are neither, since a plugin's environment has its own.
std::vector<std::string> failure_words(const std::set<std::string>& found = {});

/// The layouts that can show the scenario's scenes. The first is the default.
std::vector<std::string> layouts_of(const Scenario& scenario);
/// What a method is told of the actions of the scenario's task.
const ActionSpace& actions_of(const Scenario& scenario);
/// What a method is told of the states of the scenario's task.
const std::vector<StateNumber>& state_of(const Scenario& scenario);
/// How many instances an observation may have.
int most_instances_of(const Scenario& scenario);
/// The environment's task of that id. @throws InputError that lists the known ones.
const TaskInfo& find_task(const EnvironmentType& environment, const std::string& id);

}  // namespace lgabench

/// What the library of an environment defines.
extern "C" const lgabench::EnvironmentType* lgabench_environment();
