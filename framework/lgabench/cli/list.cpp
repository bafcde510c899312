// lgabench list: what there is to run. Reads descriptors and JSON, runs nothing of a plugin.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench::cli {
namespace {

constexpr const char* sections[] = {"methods", "reference rows", "engines", "environments", "suites", "scenarios"};

// Shipped suites with what each says it is for, sorted by id.
Json suites() {
  const fs::path directory = data_directory() / "suites";
  std::error_code none_to_list;
  Json all = Json::array();
  for (const std::string& id : json_names(directory, none_to_list)) {
    const fs::path file = directory / (id + ".json");
    const Json suite = read_json(file);
    const JsonReader reader(suite, file.string());
    all.push_back({{"id", id}, {"summary", reader.has("note") ? reader.at("note").string() : ""}});
  }
  return all;
}

Json environments() {
  Json all = Json::array();
  for (const std::string& id : environment_ids()) {
    std::vector<std::string> tasks;
    for (const TaskInfo& task : find_environment(id).tasks()) tasks.push_back(task.id);
    all.push_back({{"id", id}, {"tasks", tasks}, {"summary", fmt::format("tasks: {}", fmt::join(tasks, ", "))}});
  }
  return all;
}

Json scenarios() {
  Json all = Json::array();
  for (const std::string& id : scenario_ids()) {
    const Scenario scenario = load_scenario(id);
    all.push_back({{"id", id}, {"task", scenario.task}, {"summary", scenario.commands.front().utterance}});
  }
  return all;
}

Json listing(const Catalogue& catalogue) {
  Json all{{"methods", Json::array()}, {"reference rows", reference_rows()},
           {"engines", Json::array()}, {"environments", environments()},
           {"suites", suites()},       {"scenarios", scenarios()},
           {"refused", Json::array()}};
  for (const PluginInfo& plugin : catalogue.plugins)
    all[plugin.kind + "s"].push_back(
        {{"id", plugin.id}, {"version", plugin.version}, {"summary", plugin.summary}, {"file", plugin.file.string()}});
  for (const auto& [file, reason] : catalogue.refused)
    all["refused"].push_back({{"file", file.string()}, {"reason", reason}});
  return all;
}

void print_list(const Json& all) {
  for (const char* section : sections) {
    to_stdout("{}\n", section);
    std::size_t width = 0;
    for (const Json& row : all[section]) width = std::max(width, row["id"].get_ref<const std::string&>().size());
    for (const Json& row : all[section])
      to_stdout("  {:<{}}  {}{}{}\n", row["id"].get<std::string>(), width, row.value("version", ""),
                row.contains("version") ? "  " : "", row["summary"].get<std::string>());
    if (all[section].empty()) to_stdout("  (none)\n");
  }
  for (const Json& row : all["refused"])
    to_stderr("refused: {}: {}\n", row["file"].get<std::string>(), row["reason"].get<std::string>());
}

}  // namespace

Json reference_rows() {
  return {{{"id", "constant_action"},
           {"summary", "The best constant action: the same in every scene, from the training actions alone"}},
          {{"id", "most_shared"},
           {"summary", "The visible object that shares types and textures with most others (suites that ask for it)"}},
          {{"id", "never_demonstrated"},
           {"summary", "A visible object that is like no demonstrated target (suites that ask for it)"}},
          {{"id", "oracle"}, {"summary", "The expert, who knows the target: what success there can be"}},
          {{"id", "random_object"}, {"summary", "A visible object, drawn at random and handled as the expert would"}}};
}

void add_list(CLI::App& app, int& exit) {
  struct ListArguments {
    bool json = false;
    std::vector<fs::path> directories;
  };
  const auto arguments = std::make_shared<ListArguments>();
  CLI::App* verb = app.add_subcommand(
      "list", "List methods, engines, environments, suites and scenarios, and plugins that were refused");
  verb->footer("Example: lgabench list --plugin-path my/build");
  verb->add_flag("--json", arguments->json, "One JSON object on stdout");
  add_plugin_path(*verb, arguments->directories);
  add_scenario_path(*verb);
  verb->callback([arguments, &exit] {
    const Json all = listing(scan_plugins(plugin_directories(arguments->directories)));
    if (arguments->json)
      to_stdout("{}\n", all.dump(2));
    else
      print_list(all);
    exit = ok;
  });
}

}  // namespace lgabench::cli
