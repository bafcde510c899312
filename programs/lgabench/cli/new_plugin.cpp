// lgabench new-plugin NAME: a working project of a plugin, outside lgabench's tree.
#include <fmt/format.h>

#include <array>
#include <cctype>
#include <map>
#include <memory>

#include <lgabench/abstraction/reading.hpp>
#include <lgabench/cli/own_names.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/filled.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/core/version.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/reference_rows.hpp>

namespace lgabench::cli {
namespace {

struct NewPluginArguments {
  std::string name, kind = "method", language = "c++", with;
  fs::path directory;
};

// A library that a method may use beside lgabench's: what CMake says of it.
struct Library {
  const char *found, *linked;
  const char* precompiled = "";
};
const std::map<std::string, Library> libraries{
    {"", {"", ""}},
    {"opencv", {"find_package(OpenCV REQUIRED COMPONENTS core imgproc)\n", " opencv_core opencv_imgproc"}},
    {"torch",
     {"find_package(Torch REQUIRED)\n", " ${TORCH_LIBRARIES}",
      "# These headers take most of a compiler's time: they are read once.\n"
      "target_precompile_headers(${PROJECT_NAME} PRIVATE <lgabench/plugin/plugin.hpp> "
      "<lgabench/learning/torch_learner.hpp>)\n"}}};

// Classes that a template names, and words of Python that look like one.
const std::array<std::string, 23> other_classes{"Environment", "Result",   "Action",       "CloningMethod",
                                                "Colour",      "Command",  "FeatureSet",   "FeatureSpace",
                                                "Json",        "Method",   "None",         "False",
                                                "True",        "Needs",    "Observation",  "ObservationPerturbation",
                                                "Perceiver",   "Policy",   "PolicyInputs", "RandomStream",
                                                "Selection",   "Services", "Sum"};

// my_method -> MyMethod
std::string class_name(const std::string& name) {
  std::string text;
  bool upper = true;
  for (const char c : name) {
    if (c != '_') text += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    upper = c == '_';
  }
  return contains(other_classes, text) ? text + "Plugin" : text;
}

// Names that CMake keeps for its own targets.
const std::array<std::string, 10> cmake_targets{"all",     "clean",          "edit_cache", "help",          "install",
                                                "package", "package_source", "preinstall", "rebuild_cache", "test"};

// Modules that a plugin in Python imports, or that these import: a file of such a name would be found in their place.
const std::array<std::string, 14> python_modules{
    "array",           "collections", "dataclasses", "enum",   "json", "lgabench", "lgabench_environment",
    "lgabench_method", "math",        "numpy",       "random", "time", "torch",    "typing"};

// Another thing of that name would be found in place of the plugin, or refuse it.
void expect_free(const NewPluginArguments& a) {
  const std::string kind = a.kind == "python" ? "method" : a.kind;
  const Catalogue catalogue = scan_plugins(plugin_directories());
  std::vector<std::string> taken;
  for (const PluginInfo& plugin : catalogue.plugins)
    if (plugin.kind == kind) taken.push_back(plugin.id);
  if (kind == "method")
    for (const ReferenceRow& row : lgabench::reference_rows()) taken.push_back(row.id);
  if (kind == "perturbation")
    for (const std::string& axis : perturbation_ids()) taken.push_back(axis);
  if (kind == "perceiver") {
    taken.insert(taken.end(), names_read().begin(), names_read().end());
    taken.emplace_back(Reading::simulator);
  }
  if (kind == "environment")
    for (const std::string& id : environment_ids()) taken.push_back(id);
  if (contains(taken, a.name))
    throw InputError(fmt::format("new-plugin: expected another id than {}, which {} {} that lgabench finds has", a.name,
                                 kind.front() == 'e' ? "an" : "a",
                                 kind == "perturbation" ? "perturbation axis" : kind));
  if (contains(cmake_targets, a.name))
    throw InputError(fmt::format("new-plugin: expected another id than {}, which CMake has a target of", a.name));
  if ((a.language == "python" || a.kind == "python") && contains(python_modules, a.name))
    throw InputError(
        fmt::format("new-plugin: expected another id than {}, which is a module's that plugins use", a.name));
}

void new_plugin(const NewPluginArguments& a) {
  expect_plain_name("new-plugin", a.name);
  expect_free(a);
  if (a.language == "python" && a.kind == "engine")
    throw InputError("new-plugin: --language python: expected another kind, an engine is in C++");
  if (!a.with.empty() && (a.kind != "method" || a.language == "python"))
    throw InputError("new-plugin: --with " + a.with + ": expected a method in C++");
  const fs::path directory = a.directory.empty() ? fs::path(a.name) : a.directory;
  if (std::error_code error; fs::exists(directory, error))
    throw InputError(fmt::format("{}: exists already; nothing was written", directory.string()));
  const fs::path prefix = fs::weakly_canonical(program_directory().parent_path());
  const fs::path templates = data_directory() / "templates";
  const std::string version = LGABENCH_VERSION;
  const std::string number = version.substr(0, version.find('-'));  // as CMake compares it
  const auto write = [&](const fs::path& from, const std::string& to) {
    write_file(directory / to, filled(read_file(templates / from),
                                      {{"@NAME@", a.name},
                                       {"@CLASS@", class_name(a.name)},
                                       {"@KIND@", a.kind},
                                       {"@FOUND@", libraries.at(a.with).found},
                                       {"@LINKED@", libraries.at(a.with).linked},
                                       {"@PRECOMPILED@", libraries.at(a.with).precompiled},
                                       {"@VERSION@", version},
                                       {"@NUMBER@", number},
                                       {"@PREFIX@", to == "README.md" ? path_word(prefix) : prefix.string()}}));
    to_stdout("{}\n", (directory / to).string());
  };
  const bool has_own_template = a.kind == "perturbation" || a.kind == "perceiver" || a.kind == "environment";
  if (a.kind == "perturbation") write("perturbation_suite.json.in", a.name + "_suite.json");
  const auto write_example = [&](const std::string& example, const std::string& type,
                                 const std::string& file = ".cpp") {
    const std::string source = read_file(data_directory() / "starters" / example / (example + file));
    const fs::path to = directory / (a.name + file);
    write_file(to, filled(source, {{'"' + example + '"', '"' + a.name + '"'},
                                   {'"' + example + "_", '"' + a.name + "_"},
                                   {'"' + example + ": ", '"' + a.name + ": "},
                                   {"info " + example, "info " + a.name},
                                   {"set " + example, "set " + a.name},
                                   {type, class_name(a.name)}}));
    to_stdout("{}\n", to.string());
  };
  if (a.kind == "environment")
    for (const char* file : {"_red.json", "_blind.json", "_suite.json"}) write_example("reach2d", "Reach2d", file);
  if (a.kind == "python" || a.language == "python") {
    write((has_own_template ? a.kind : "python") + ".py.in", a.name + ".py");
    write((has_own_template ? "python_" + a.kind : "python") + ".README.md.in", "README.md");
    return;
  }
  if (a.kind == "engine")
    write_example("kinematic", "KinematicWorld");  // the smallest engine that fulfils the contract
  else if (a.kind == "environment")
    write_example("reach2d", "Reach2d");
  else if (a.with == "torch")
    write_example("own_network", "OwnNetwork");
  else
    write(a.kind + ".cpp.in", a.name + ".cpp");
  write(a.kind + ".README.md.in", "README.md");
  const bool links_more = a.kind == "method" || a.kind == "engine";
  write("CMakeLists." + (links_more ? a.kind : "plugin") + ".txt.in", "CMakeLists.txt");
  write("CMakePresets.json.in", "CMakePresets.json");
}

}  // namespace

void add_new_plugin(CLI::App& app, int& exit) {
  auto a = std::make_shared<NewPluginArguments>();
  Verb verb(app, "new-plugin", "Write a working project for a new plugin, for you to change");
  verb.option("name NAME", a->name, "The plugin's id: lower-case letters, digits, underscores", required);
  verb.option("--kind method|engine|perturbation|perceiver|environment|python", a->kind,
              "method, engine, perturbation, perceiver or environment; python: a method in Python",
              one_of("kind", {"method", "engine", "perturbation", "perceiver", "environment", "python"}), with_default);
  verb.option("--language c++|python", a->language, "c++, or python for all but an engine",
              one_of("language", {"c++", "python"}), with_default);
  verb.option("--with torch|opencv", a->with,
              "For a method in C++: also link LibTorch, with a network to start from, or OpenCV",
              one_of("with", {"torch", "opencv"}));
  verb.option("--directory DIR", a->directory, "The project's directory (default: ./NAME); it must not exist yet");
  verb->footer("Example: lgabench new-plugin my_method && cd my_method && cmake --workflow --preset release");
  verb->callback([a, &exit] {
    new_plugin(*a);
    exit = ok;
  });
}

}  // namespace lgabench::cli
