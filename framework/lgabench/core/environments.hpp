// The environments that are installed: what the framework asks of one beside playing scenes (environment.hpp).
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
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
};

/// All that a scene depends on (docs/protocol.md, section 3): not engine, method, thread or host.
struct SceneRequest {
  std::string layout;  // one of the task's
  std::string split;   // train, dev or test
  std::string arm;     // of the scenario's tests, or "train" for training scenes
  std::uint64_t seed = 0;
  /// Of training targets and second sets where the scenario leaves them to the method: one a command, only the
  /// distributions count. Empty: the truth.
  std::vector<Selection> selections = {};
  /// Of test scenes that one training seed has to itself: part of their random streams. None: shared by all seeds.
  std::optional<std::uint64_t> training_seed = {};
};

/// The part of a random stream's name that tells training seeds with scenes of their own apart; "" where all share
/// them.
std::string own_stream(std::optional<std::uint64_t> training_seed);

/// How far an action lies from another one that should do the same.
struct ActionDistance {
  double begin_m = 0, end_m = 0;  // between the places where they begin, and where they end
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

/// A kind of environment: one object, constant, for as long as the program runs. Any thread, but draw().
class EnvironmentType {
 public:
  virtual ~EnvironmentType() = default;

  virtual const std::string& id() const = 0;
  /// In the order in which tables and checks name them.
  virtual const std::vector<TaskInfo>& tasks() const = 0;
  /// Every word that step() may give for a failure but the framework's own, in the order in which reports list them.
  virtual const std::vector<std::string>& failures() const = 0;

  /// What the numbers of its actions mean.
  virtual const ActionSpace& action_space() const = 0;
  /// Likewise, as methods are told it: with the stations that the task has, if it has any.
  virtual const ActionSpace& action_space_of(const TaskInfo& /*task*/) const { return action_space(); }
  /// Of each observation.
  virtual PictureSize picture_size() const = 0;
  /// How many instances an observation of that task may have, whatever the scenario.
  virtual int most_instances(const TaskInfo& task) const = 0;
  /// Where the camera shows a point of the world, in metres: x its column, y its row, in pixels, 0 at the picture's
  /// corner; also outside of the picture.
  virtual Vec2 in_picture(Vec3 point_m) const = 0;

  /// Members that a scenario's file may have for the environment to read: beside those of scenario.hpp, and in "train"
  /// and each of "tests" beside those of Arm.
  virtual std::vector<std::string> scenario_members(const TaskInfo& task) const = 0;
  virtual std::vector<std::string> scene_members(const TaskInfo& task) const = 0;
  /// Reads what scenes of one kind hold. `file`: the whole scenario; `scenes`: its "train", null where it has none, or
  /// one of its "tests". `scenario` is complete but for these. @throws InputError with file and place.
  virtual std::shared_ptr<const SceneContent> read_content(const Scenario& scenario, const JsonReader& file,
                                                           const JsonReader* scenes, bool training) const = 0;

  /// Scene number `index`. @throws InputError where layout, split or arm is unknown; NothingToShow where a Selection or
  /// the truth holds no target, or nothing of the second set, that the layout can show.
  virtual Scene sample(const Scenario& scenario, const SceneRequest& request, int index) const = 0;
  /// Of what the scenario's commands mean, what that request's training scenes show where it is not all: of each
  /// command a list of [object type, texture]; null where nothing is left out.
  virtual Json shown_members(const Scenario& /*scenario*/, const SceneRequest& /*request*/) const { return nullptr; }
  /// How scenes of that kind are perceived, beside the noise that every environment's arms may ask for (scenario.hpp):
  /// null where nothing errs, as it is unless an environment says otherwise.
  virtual Perceive perception(const SceneContent& /*scenes*/) const { return nullptr; }
  /// Of two actions in that task; none where an action's poses alone do not decide it, as it is unless an environment
  /// says otherwise.
  virtual std::optional<ActionDistance> distance(const TaskInfo& /*task*/, const Action& /*one*/,
                                                 const Action& /*other*/) const {
    return std::nullopt;
  }
  /// The object type of the place to bring things to, which no command means; "" where there is none.
  virtual std::string goal_type() const { return ""; }
  /// Of the task's layouts, those that can show the scenario's scenes: all, unless an environment says otherwise.
  virtual std::vector<std::string> layouts_of(const Scenario& scenario) const;
  /// How many more distractors test scenes of the scenario's first arm have room for: 0 unless an environment says
  /// otherwise.
  virtual int room_for_distractors(const Scenario& /*scenario*/) const { return 0; }
  /// The scene, of a test arm, with so many more, uniform ones or near misses of the target. One stream gives those of
  /// a smaller count and then others; the control's objects stay where they are. @throws NothingToShow where none fits.
  virtual Scene with_distractors(const Scenario& scenario, Scene scene, int count, bool near_miss,
                                 RandomStream random) const;
  /// The scene with everything that can be brought somewhere, or swept, of that size, times its type's.
  virtual Scene resized(Scene scene, double scale) const;
  /// The scene with a target as large as room is left for, by 5 mm: of the greatest of `scales`, which grow, if any.
  virtual Scene with_larger_target(Scene scene, const std::vector<double>& scales) const;
  /// What is seen at the scene's beginning, without an engine. One thread at a time.
  virtual Observation draw(const Scene& scene, const View& view) const = 0;
  Observation draw(const Scene& scene) const { return draw(scene, View()); }
  /// Whether draw() and Environment::look() show other views than the usual one.
  virtual bool has_views() const { return false; }
  /// How an engine's world for the scenario differs from that for most of the environment's, "" where it does not: what
  /// demonstrations in it depend on.
  virtual std::string world_of(const Scenario& /*scenario*/) const { return ""; }
  /// An environment on that engine, for scenes of that scenario. @throws EngineError if the engine fails.
  virtual std::unique_ptr<Environment> make(std::unique_ptr<PhysicsWorld> engine, const Scenario& scenario) const = 0;
};

/// The environment named `id`: the shared library lgabench_env_ID beside lgabench's own, loaded when it is first asked
/// for. @throws InputError for one that is not installed.
const EnvironmentType& find_environment(const std::string& id);

/// Ids of all that are installed, sorted.
std::vector<std::string> environment_ids();

/// Tasks of all that are installed.
std::vector<TaskInfo> installed_tasks();
/// Their ids.
std::vector<std::string> installed_task_ids();
/// Layouts of all tasks, each once.
std::vector<std::string> installed_layouts();
/// Words for a failure, in a report's order: of all environments, then the framework's.
std::vector<std::string> failure_words();

/// The layouts that can show the scenario's scenes; the first is meant where none is named.
std::vector<std::string> layouts_of(const Scenario& scenario);
/// What a method is told of the actions of the scenario's task.
const ActionSpace& actions_of(const Scenario& scenario);
/// How many instances an observation may have.
int most_instances_of(const Scenario& scenario);
/// The environment's task of that id. @throws InputError that lists the known ones.
const TaskInfo& find_task(const EnvironmentType& environment, const std::string& id);

}  // namespace lgabench

/// What the library of an environment defines.
extern "C" const lgabench::EnvironmentType* lgabench_environment();
