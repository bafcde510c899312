// Finding plugins by their bytes, and loading those that fit. One thread.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/method.hpp>
#include <lgabench/core/observation_perturbation.hpp>
#include <lgabench/core/perceiver.hpp>
#include <lgabench/core/physics_world.hpp>

namespace lgabench {

namespace fs = std::filesystem;

/// What a plugin's descriptor says. It was checked: the plugin fits this program as far as bytes can tell.
struct PluginInfo {
  fs::path file;
  std::string kind, id, version, summary, fingerprint;
  Json options;        // {name: {"default", "help", "source", "values"?, "min"?, "max"?, "words"?, "needs"?,
                       // "framework"?}}
  std::string sha256;  // of the file
  std::string asks{};  // "specify", "edit", "accept", "truth", "network" or "": see LGABENCH_METHOD_ASKING
  /// What a method in Python has (host/python_method.hpp): {"class", "interpreter", "reads", "user_base",
  /// "versions"}; else null.
  Json python{};
  bool questionnaire = false;  // of a method: see LGABENCH_QUESTIONNAIRE
  bool kinematic = false;      // of an engine: see LGABENCH_KINEMATIC_ENGINE
  Json axis{};                 // of a perturbation, as axis_json() of core/perturbations.hpp; else null
};

/// The JSON of every member, under its name.
Json to_json(const PluginInfo& plugin);

/// Reads the file's bytes and runs nothing of it. @throws PluginError naming the file, the cause and, for a mismatch,
/// both sides.
PluginInfo read_plugin(const fs::path& file);

/// A file that is no plugin for this program, and why.
struct Refusal {
  fs::path file;
  std::string reason;
};

/// What was found in the plugin directories.
struct Catalogue {
  std::vector<PluginInfo> plugins;
  std::vector<Refusal> refused;

  /// `kind` is "method", "engine", "perturbation", "perceiver" or "environment". @throws PluginError that lists the
  /// known ids and repeats the refusal of a file of that name.
  const PluginInfo& find(const std::string& kind, const std::string& id) const;
  /// The engine on which cells of that environment play that say `id`; none where the environment has no engine plugin.
  /// @throws InputError for own_engine where there must be a plugin, and for another id where there is none; as find().
  std::optional<PluginInfo> engine(const std::string& id, const EnvironmentType& environment) const;
  /// "; FILE was refused: REASON" for each file of that name, and for each directory.
  std::string refusals_of(const std::string& id) const;
};

/// Where plugins are looked for: the shipped ones', $LGABENCH_PLUGIN_PATH (colon-separated), then `extra` (from the
/// command line). Directories, or .so files.
std::vector<fs::path> plugin_directories(const std::vector<fs::path>& extra = {});

/// A folder that Python packages are installed into: it has their *.dist-info.
bool is_site_packages(const fs::path& directory);

/// Reads each *.so of the directories, in their order and by name within each; one may also be a .so itself, and one of
/// installed Python packages is left out (host/installed_methods.hpp). What is
/// refused does not stop the rest, and a directory without a *.so is refused;
/// of two with the same kind and id the later is refused. Environments among them are known from then on
/// (find_environment()), and opened where they are asked for.
Catalogue scan_plugins(const std::vector<fs::path>& directories);

/// Opens the plugin (for good: it is never closed) and makes one object of it.
/// @throws PluginError if the file changed since it was read, cannot be opened (names the undefined symbol), or its
/// factory throws or returns nothing.
std::unique_ptr<Method> load_method(const PluginInfo& plugin);
/// Null for none.
std::unique_ptr<PhysicsWorld> load_engine(const std::optional<PluginInfo>& plugin);
std::unique_ptr<ObservationPerturbation> load_perturbation(const PluginInfo& plugin);
std::unique_ptr<Perceiver> load_perceiver(const PluginInfo& plugin);
/// Sets what makes environments of plugins in Python; without it there are none. One thread, before the others.
void make_python_environments(std::function<const EnvironmentType*(const PluginInfo& plugin)> make);
/// Makes an environment's plugin known, which is opened when find_environment() is asked for its id. @throws as
/// add_environment()
void add_environment(const PluginInfo& plugin);

/// Adds the axes of its perturbations (add_plugin_axis). One whose id is taken is refused.
void add_axes(Catalogue& catalogue);

/// Reads an option's value from a command line: a number, or true or false, if the whole word is one; else a text.
Json option_value(const std::string& word);
/// Writes an option's value as a command line and a row's name have it.
std::string option_text(const Json& value);
/// What "min" and "max" of an option allow: "from 0 to 1", "of 1 or more", "of 1 or less", or "".
std::string range_text(const Json& option);
/// "ID+OPTION=VALUE+OPTION=VALUE", as rows are written and named -> "ID", "OPTION=VALUE", "OPTION=VALUE". Behind the
/// first '+' another one separates only at the end and before a letter, so that a value may be 1e+30.
std::vector<std::string> row_words(const std::string& row);
/// The method's id in such a row, also in one whose method selects alone.
std::string row_id(const std::string& row);

/// The beginning of a row whose plugin selects alone, while the shipped policy learns and acts: "selected_by:ROW".
constexpr const char* selected_by = "selected_by:";
bool selects_alone(const std::string& row);
/// ROW of such a row; any other as it is.
std::string without_selected_by(const std::string& row);

/// Every option of the plugin: those of `overrides` (an object), defaults for the rest. A whole number given for an
/// option with a fractional default becomes fractional.
/// @throws InputError for an unknown option, a value of another type than the default's or not among its values, and
/// for one whose needs of other options are not met.
Json resolve_options(const PluginInfo& plugin, const Json& overrides);
/// Checks options one by one, without their needs, since the object need not be all that is given.
Json check_options(const PluginInfo& plugin, const JsonReader& given);

}  // namespace lgabench
