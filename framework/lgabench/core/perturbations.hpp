// Perturbation axes. Each is one way in which a test scene, as it is seen, differs from the control's
// (docs/protocol.md, section 8).
#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>
#include <lgabench/core/observation.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/view.hpp>

namespace lgabench {

/// The parts of an episode that a record compares, in its order.
enum class EpisodePart { objects, physics, rgb, ids, instances, words, answers, selection, input, control };
/// Their names in a record.
constexpr std::array part_names{"objects", "physics", "rgb",       "ids",   "instances",
                                "words",   "answers", "selection", "input", "control"};
constexpr std::size_t parts = part_names.size();

/// How a body may differ from its type: factors on the type's values.
struct BodyVariant {
  double scale = 1, friction = 1, mass = 1;
};
bool operator==(const BodyVariant& a, const BodyVariant& b);

/// The bodies of an axis' scenes at one level: any of these sizes, one friction and one mass.
struct BodyVariants {
  std::vector<double> scales{1};
  double friction = 1, mass = 1;
  int more = 0;  // bodies beside the control's
};

/// One axis. Level 0 is the control, which stays as it is. The stream is the episode's own and the same at every level:
/// it gives the direction of a change, and the level gives the size alone.
struct PerturbationAxis {
  std::string id;
  std::vector<std::string> levels;           // what each is, in a few words; the first is level 1
  std::vector<EpisodePart> changes;          // in nearly every episode
  std::vector<EpisodePart> may_change = {};  // in some
  /// What is perceived at that level. Null: the axis leaves perception as it is.
  std::function<Observation(Observation, const Scenario&, int level, RandomStream)> perceive = nullptr;
  /// How likely each true feature is missing from what was selected, and each wrong one added. Null: Selections stay.
  std::function<double(int level)> selection_errors = nullptr;
  /// Changes how the scene is looked at. Null: not at all.
  std::function<void(View&, const Scene&, int level, RandomStream)> look = nullptr;
  /// The control's scene, changed. Null: the scene stays.
  std::function<Scene(Scene, const Scenario&, int level, RandomStream)> change = nullptr;
  /// The bodies that change() may ask for, which engines are told beforehand. Null: the usual ones.
  std::function<BodyVariants(int level)> bodies = nullptr;
  bool rewords = false;  // gives the scenario's command in the words of that level (ScenarioCommand::wording)
  /// Another command that is demonstrated: its words are given in place of the scene's own. Null: the words stay.
  std::function<int(const Scene&, const Scenario&, RandomStream)> other = nullptr;
  /// Commands without a meaning, which are given in place of both at that level and which a scenario's arm adds
  /// (add_words()).
  std::function<std::vector<std::string>(int level)> words = nullptr;
  /// Why scenes of the scenario cannot have it at that level, in a few words; "" where they can. Null: all can.
  std::function<std::string(const Scenario&, int level)> lacks = nullptr;
  bool named = false;  // its levels are kinds without an order: no curve, no area
  bool of_all = true;  // `all` applies it. A new axis would change what `all` has always meant
  bool of_plugin = false;
  std::string version = "";  // the plugin's

  int most() const { return static_cast<int>(levels.size()); }
  /// Whether the part may differ from the control's. The policy's input may wherever a part of it may.
  bool touches(EpisodePart part) const;
};

/// The word for every axis at once.
inline constexpr const char* all_axes = "all";

/// The file that defines them.
inline constexpr const char* perturbation_library = "liblgabench_perturbations.so";

/// All that are installed, in the order in which `all` applies them: that library beside
/// lgabench's own, loaded when it is first asked for. @throws InputError where it is not there.
const std::vector<PerturbationAxis>& perturbation_axes();

/// The axes that were added, in that order.
const PluginAxes& plugin_axes();
/// Adds an axis for all that is read from now on. It is no part of `all`. @throws InputError for an id that is taken.
void add_plugin_axis(PerturbationAxis axis);
/// The parts' names.
std::vector<std::string> part_words(const std::vector<EpisodePart>& some);
/// {"version", "levels", "changes", "may_change", "named"}, the last two where they say something: what a plugin's axis
/// declares.
Json axis_json(const PerturbationAxis& axis);
/// The axis of axis_json(), or of a plugin's declaration, which has no version. Until perceive() is set, it throws
/// InputError.
/// @throws InputError with file and place, also for a part that is not perceived.
PerturbationAxis read_axis(const std::string& id, const JsonReader& reader);

/// Ids of all axes, those of plugins behind lgabench's own, and last `all`.
std::vector<std::string> perturbation_ids(const PluginAxes& more = plugin_axes());
/// The axis of that id, or every one of lgabench's own for `all`. @throws InputError that lists the known ones.
std::vector<const PerturbationAxis*> axes_named(const std::string& id, const PluginAxes& more = plugin_axes());

/// The axes of a perturbation of the scenario's: of `all`, those that the scenario can have. An arm that was read has
/// its own.
std::vector<const PerturbationAxis*> axes_of(const Scenario& scenario, const Perturbation& perturbation);
/// As PerturbationAxis::lacks, of an axis that changes what an engine plugin simulates.
std::string lacks_engine(const Scenario& scenario, int level);
/// Why the scenario cannot have the axis, in a few words; "" where it can. Every scenario can have `all`.
std::string lacking(const Scenario& scenario, const Perturbation& perturbation);
/// Every body that scenes of the scenario's arms may ask for, the usual one first.
std::vector<BodyVariant> body_variants(const Scenario& scenario);
/// How many bodies more than in their control's scenes they may ask for.
int more_bodies(const Scenario& scenario);

/// {"AXIS": LEVEL}, an axis or `all`. @throws InputError with file and place for an unknown axis, a level that it
/// lacks, two axes.
Perturbation read_perturbation(const JsonReader& reader, const PluginAxes& more = plugin_axes());
/// What a scenario's "axes" declare, {"AXIS": axis_json()}, where it has them, and behind them those that were added.
/// @throws InputError likewise.
PluginAxes read_plugin_axes(const JsonReader& scenario);
/// @throws InputError with file and place where one of the axes changes views, and the environment has its usual one
/// alone.
void expect_shown(const JsonReader& perturbation, const std::vector<const PerturbationAxis*>& axes,
                  const std::string& environment, bool has_views);
/// The axis of the scenario's arms that gives other commands (PerturbationAxis::other), nullptr where none does. It is
/// no part of `all`.
const PerturbationAxis* instructing_axis(const Scenario& scenario);
/// The command whose words are given in the scene: its own, but for such an axis. `training_seed`: as in SceneRequest.
int command_given(const Scene& scene, const Scenario& scenario, std::optional<std::uint64_t> training_seed);
/// Whether an object of that type and texture is in what is meant, whichever of several it says.
bool means(const ScenarioCommand& command, const SceneObject& object);
/// "AXIS_LEVEL": an arm's name.
std::string arm_of(const Perturbation& perturbation);

/// The arm's scene, changed by its axes where it has a perturbation. `training_seed`: as in SceneRequest. @throws as
/// EnvironmentType::with_distractors() and resized().
Scene perturbed(Scene control, const Scenario& scenario, std::optional<std::uint64_t> training_seed);

/// The stream of one axis in one test scene, after so many of its steps; `training_seed`: as in SceneRequest.
RandomStream perturbation_stream(const std::string& axis, const Scene& scene,
                                 std::optional<std::uint64_t> training_seed, int step = 0);

}  // namespace lgabench

/// What the library defines.
extern "C" const std::vector<lgabench::PerturbationAxis>* lgabench_perturbations();
