// lgabench info NAME: all that is known of a method, an engine, a suite or a scenario before anything of it runs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include <lgabench/abstraction/selection_text.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/shipped.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/host/python_method.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench::cli {
namespace {

// What it declares.
void print_info(const PerturbationAxis& axis) {
  for (std::size_t i = 0; i < axis.levels.size(); ++i) to_stdout("  level {:<4}  {}\n", i + 1, axis.levels[i]);
  to_stdout("  changes     {}\n", fmt::join(part_words(axis.changes), ", "));
  if (!axis.may_change.empty()) to_stdout("  sometimes   {}\n", fmt::join(part_words(axis.may_change), ", "));
}

void print_info(const PluginInfo& plugin) {
  to_stdout("{} {}, {} {}\n", plugin.id, plugin.version, plugin.kind.front() == 'e' ? "an" : "a", plugin.kind);
  to_stdout("  {}\n  file        {}\n  sha256      {}\n  built with  {}\n", plugin.summary, plugin.file.string(),
            plugin.sha256, plugin.fingerprint);
  if (!plugin.asks.empty())
    to_stdout("  asks        {}\n", plugin.asks == "truth"    ? "for the truth: a diagnosis"
                                    : plugin.asks == "accept" ? "people to accept objects that they are shown"
                                                              : "people to " + plugin.asks);
  if (plugin.kind == "perturbation") print_info(read_axis(plugin.id, JsonReader(plugin.axis, plugin.file.string())));
  if (plugin.options.empty()) return;
  to_stdout("options, set with --set {}.NAME=VALUE\n", plugin.id);
  for (const auto& [name, option] : plugin.options.items()) {
    to_stdout("  {} = {}\n      {} ({})\n", name, canonical(option["default"]), option["help"].get<std::string>(),
              option["source"].get<std::string>());
    if (const std::string range = range_text(option); !range.empty()) to_stdout("      {}\n", range);
    if (option.contains("words")) to_stdout("      or one of {}\n", canonical(option["words"]));
    if (option.contains("values")) to_stdout("      one of {}\n", canonical(option["values"]));
    if (option.value("framework", false)) to_stdout("      the framework's: a suite may set it for all methods\n");
    if (option.contains("needs"))
      for (const auto& [value, others] : option["needs"].items())
        for (const auto& [other, values] : others.items())
          to_stdout("      {} needs {} to be one of {}\n", value, other, canonical(values));
  }
}

std::string names(const std::vector<std::string>& chosen, const std::vector<std::string>& all) {
  return chosen.size() == all.size() ? fmt::format("all {}", all.size()) : fmt::format("{}", fmt::join(chosen, ", "));
}

void print_info(const Scenario& scenario) {
  to_stdout("{}, a scenario in {}\n  task        {}\n", scenario.id, scenario.environment->id(), scenario.task);
  const auto print_set = [&scenario](const char* role, const FeatureSet& set) {
    to_stdout("  {:<10}  {}; textures: {}\n", role, names(set.object_types, scenario.space.object_types),
              names(set.textures, scenario.space.textures));
  };
  for (const ScenarioCommand& command : scenario.commands) {
    to_stdout("  command     {}{}\n", command.utterance, command.seen ? "" : "  (not demonstrated)");
    for (const FeatureSet& set : command.truth.target.sets) print_set("target", set);
    if (command.truth.target.which || !command.truth.target.turns.empty())
      to_stdout("  in words    {}\n", selection_text(command.truth, scenario.space));
    if (command.truth.second) print_set(command.truth.second->role.c_str(), *command.truth.second);
  }
  to_stdout("  answers     {}{}\n", scenario.recorded,
            scenario.edited == scenario.recorded ? "" : fmt::format("; people edit {}", scenario.edited));
  std::vector<std::string> arms;
  for (const Arm& arm : scenario.tests) arms.push_back(arm.id);
  to_stdout("  tests       {}\n", fmt::join(arms, ", "));
  const JsonReader reader(scenario.json, scenario.id);
  if (reader.has("note")) to_stdout("  note        {}\n", reader.at("note").string());
}

void print_info(const Suite& suite) {
  to_stdout("{}, a suite in {}\n  file  {}\n", suite.id, suite.environment, suite.file);
  const auto words_of = [](const Json& value) {
    if (!value.is_array()) return value.is_string() ? value.get<std::string>() : canonical(value);
    std::vector<std::string> words;
    for (const Json& one : value) words.push_back(one.is_string() ? one.get<std::string>() : canonical(one));
    return fmt::format("{}", fmt::join(words, ", "));
  };
  const auto print_members = [&words_of](const Json& members) {
    for (const auto& [name, value] : members.items()) to_stdout("    {:<14}  {}\n", name, words_of(value));
  };
  to_stdout("  how many cells, and how long they take: lgabench run {} --dry-run\n  grid\n", suite.id);
  print_members(to_json(suite.design));
  for (const auto& [name, members] : suite.presets.items()) {
    to_stdout("  preset {}\n", name);
    print_members(members);
  }
}

Json to_json(const Suite& suite) {
  return {{"kind", "suite"},
          {"id", suite.id},
          {"environment", suite.environment},
          {"file", suite.file},
          {"grid", lgabench::to_json(suite.design)},
          {"presets", suite.presets}};
}

Json to_json(const EnvironmentType& environment) {
  Json tasks = Json::array();
  for (const TaskInfo& task : environment.tasks()) {
    tasks.push_back({{"id", task.id},
                     {"layouts", task.layouts},
                     {"failures", task.failures},
                     {"example", task.example},
                     {"most_steps", task.most_steps},
                     {"state", lgabench::to_json(environment.state_of(task))}});
    if (task.second) tasks.back()["second"] = {{"id", task.second->id}, {"phrase", task.second->phrase}};
  }
  return {{"kind", "environment"},
          {"id", environment.id()},
          {"tasks", tasks},
          {"failures", environment.failures()},
          {"has_engine", environment.has_engine()},
          {"spaces", environment.spaces()},
          {"picture", {environment.picture_size().rows, environment.picture_size().columns}},
          {"action", lgabench::to_json(environment.action_space())}};
}

std::string range_of(const ActionNumber& number) {
  return fmt::format("{} to {}{}{}", number.low, number.high, number.unit.empty() ? "" : " ", number.unit);
}

void print_info(const EnvironmentType& environment) {
  to_stdout("{}, an environment\n", environment.id());
  for (const TaskInfo& task : environment.tasks()) {
    to_stdout("  task        {}\n    layouts     {}\n", task.id, fmt::join(task.layouts, ", "));
    if (!task.failures.empty()) to_stdout("    failures    {}\n", fmt::join(task.failures, ", "));
    to_stdout("    example     {}\n", task.example);
    if (task.most_steps > 1) to_stdout("    steps       {} at most\n", task.most_steps);
    for (const StateNumber& number : environment.state_of(task))
      to_stdout("    state       {}  {}\n", number.name, range_of(number));
    if (task.second) to_stdout("    second set  {}, {}\n", task.second->id, task.second->phrase);
  }
  if (!environment.has_engine()) to_stdout("  engine      {}: no engine plugin\n", own_engine);
  const PictureSize picture = environment.picture_size();
  to_stdout("  spaces      {}\n  picture     {} x {}\n  failures    {}\n  action\n",
            fmt::join(environment.spaces(), ", "), picture.rows, picture.columns,
            fmt::join(environment.failures(), ", "));
  std::size_t width = 0;
  for (const ActionNumber& number : environment.action_space().numbers) width = std::max(width, number.name.size());
  for (const ActionNumber& number : environment.action_space().numbers)
    to_stdout("    {:<{}}  {}\n", number.name, width, range_of(number));
}

void print_reference_row(const Json& row) {
  to_stdout(
      "{}, a reference row\n  {}\n  Every run has it beside its methods, unless with --no-reference; it has no "
      "options.\n",
      row.at("id").get<std::string>(), row.at("summary").get<std::string>());
}

void print_own(const PerturbationAxis& axis) {
  to_stdout("{}, a perturbation axis\n", axis.id);
  print_info(axis);
}

Json to_json(const PerturbationAxis& axis) {
  Json json = axis_json(axis);
  json.erase("version");
  json.update({{"kind", "perturbation"}, {"id", axis.id}});
  return json;
}

// All that have the name, as an environment and a suite may; each is printed where JSON is not asked for.
Json things_named(const std::string& name, const Catalogue& catalogue, bool json) {
  Json found = Json::array();
  const auto add = [&](const auto& thing) {
    if (!json) print_info(thing);
    found.push_back(to_json(thing));
  };
  for (const PluginInfo& plugin : catalogue.plugins)
    if (plugin.id == name) add(plugin);
  for (const PerturbationAxis& axis : perturbation_axes())
    if (axis.id == name) {
      if (!json) print_own(axis);
      found.push_back(to_json(axis));
    }
  if (contains(scenario_ids(), name)) {
    const Scenario scenario = load_scenario(name);
    if (!json) print_info(scenario);
    found.push_back(scenario.json);
    found.back()["kind"] = "scenario";
  }
  if (fs::exists(data_directory() / "suites" / (name + ".json"))) add(load_suite(name));
  const bool of_plugin =
      std::any_of(catalogue.plugins.begin(), catalogue.plugins.end(),
                  [&name](const PluginInfo& one) { return one.kind == "environment" && one.id == name; });
  if (of_plugin || contains(environment_ids(), name)) add(find_environment(name));
  for (const Json& row : reference_rows())
    if (row.at("id") == name) {
      if (!json) print_reference_row(row);
      found.push_back(row);
    }
  return found;
}

[[noreturn]] void fail_unknown(const std::string& name, const Catalogue& catalogue) {
  for (const auto& [file, reason] : catalogue.refused)
    if (file.stem() == name) throw PluginError(fmt::format("{} was refused: {}", file.string(), reason));
  std::vector<std::string> known = scenario_ids();
  for (const PluginInfo& plugin : catalogue.plugins) known.push_back(plugin.id);
  for (const std::string& environment : environment_ids()) known.push_back(environment);
  for (const Json& row : reference_rows()) known.push_back(row.at("id"));
  for (const PerturbationAxis& axis : perturbation_axes()) known.push_back(axis.id);
  for (const std::string& suite : shipped_names("suites")) known.push_back(suite);
  throw InputError(fmt::format(
      "no method, engine, perturbation, suite, scenario or environment \"{}\"{}; lgabench list shows them, those of "
      "other plugins with "
      "--plugin-path DIR",
      name, suggestion(name, known)));
}

void info(const std::string& name, bool json, const std::vector<fs::path>& directories, const std::string& python) {
  const Catalogue catalogue = plugins_at(directories, python);
  const Json found = things_named(name, catalogue, json);
  if (found.empty()) fail_unknown(name, catalogue);
  if (json) to_stdout("{}\n", (found.size() == 1 ? found.front() : found).dump(2));
}

}  // namespace

void add_info(CLI::App& app, int& exit) {
  struct InfoArguments {
    std::string name, python = usual_python();
    bool json = false;
    std::vector<fs::path> directories;
  };
  const auto arguments = std::make_shared<InfoArguments>();
  Verb verb(app, "info", "Show everything known about a method, engine, perturbation, suite, scenario or environment");
  verb->footer("Example: lgabench info lga");
  verb.option("name NAME", arguments->name, "A name that `lgabench list` prints", required);
  verb.option("--json", arguments->json, "Print one JSON object, or an array where several things share the name");
  add_plugin_path(verb, arguments->directories, any_plugin);
  add_python(verb, arguments->python);
  add_scenario_path(verb);
  verb->callback([arguments, &exit] {
    info(arguments->name, arguments->json, arguments->directories, arguments->python);
    exit = ok;
  });
}

}  // namespace lgabench::cli
