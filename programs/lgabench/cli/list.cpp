// lgabench list: what there is to run. Reads descriptors and JSON, runs nothing of a plugin.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>

#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/shipped.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/answers.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/harness/suite_scenario.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/host/python_method.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/answer_source.hpp>
#include <lgabench/record/reference_rows.hpp>

namespace lgabench::cli {
namespace {

constexpr const char* sections[] = {"methods",      "reference rows", "engines",  "perturbations",
                                    "environments", "suites",         "scenarios"};

// Shipped suites with what each says it is for, sorted by id.
Json suites() {
  const fs::path directory = data_directory() / "suites";
  Json all = Json::array();
  for (const std::string& id : shipped_names("suites")) {
    const fs::path file = directory / (id + ".json");
    const Json suite = read_shipped_json(file);
    const JsonReader reader(suite, file.string());
    all.push_back({{"id", id}, {"summary", reader.has("note") ? reader.at("note").string() : ""}});
    if (reader.has("about") && reader.at("about").has("title"))
      all.back()["title"] = reader.at("about").at("title").string();
  }
  return all;
}

// lgabench's own axes.
Json perturbations() {
  Json all = Json::array();
  for (const PerturbationAxis& axis : perturbation_axes())
    all.push_back({{"id", axis.id}, {"summary", fmt::format("{}", fmt::join(axis.levels, "; "))}});
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

// Only names are found without reading files, of which there may be many.
Json scenarios(bool read) {
  Json all = Json::array();
  for (const std::string& id : scenario_ids()) {
    if (!read) {
      all.push_back({{"id", id}});
      continue;
    }
    const Scenario scenario = load_scenario(id);
    all.push_back({{"id", id}, {"task", scenario.task}, {"summary", scenario.commands.front().utterance}});
  }
  return all;
}

Json listing(const Catalogue& catalogue, bool read_scenarios) {
  Json all{{"methods", Json::array()},
           {"reference rows", reference_rows()},
           {"engines", Json::array()},
           {"perturbations", perturbations()},
           {"environments", environments()},
           {"suites", suites()},
           {"scenarios", scenarios(read_scenarios)},
           {"refused", Json::array()}};
  for (const PluginInfo& plugin : catalogue.plugins)
    all[plugin.kind + "s"].push_back(
        {{"id", plugin.id}, {"version", plugin.version}, {"summary", plugin.summary}, {"file", plugin.file.string()}});
  for (const auto& [file, reason] : catalogue.refused)
    all["refused"].push_back({{"file", file.string()}, {"reason", reason}});
  return all;
}

// "id  title", cut to a line of a terminal.
std::string short_line(const Json& row, std::size_t width) {
  constexpr std::size_t widest = 100;
  const std::string line = fmt::format("  {:<{}}  {}", row["id"].get<std::string>(), width,
                                       row.value("title", row["summary"].get<std::string>()));
  if (line.size() <= widest) return line;
  return line.substr(0, line.find_last_of(' ', widest - 4)) + " ...";
}

void print_list(const Json& all, const std::string& kind, bool is_short) {
  for (const std::string section : sections) {
    if (!kind.empty() && section != (kind == "rows" ? "reference rows" : kind)) continue;
    to_stdout("{}\n", section);
    if (section == "scenarios" && kind.empty()) {
      to_stdout("  {}: `lgabench list scenarios --short` has their commands\n", all[section].size());
      continue;
    }
    std::size_t width = 0;
    for (const Json& row : all[section]) width = std::max(width, row["id"].get_ref<const std::string&>().size());
    for (const Json& row : all[section])
      if (is_short)
        to_stdout("{}\n", short_line(row, width));
      else
        to_stdout("  {:<{}}  {}{}{}\n", row["id"].get<std::string>(), width, row.value("version", ""),
                  row.contains("version") ? "  " : "", row["summary"].get<std::string>());
    if (all[section].empty()) to_stdout("  (none)\n");
  }
  for (const Json& row : all["refused"])
    to_stderr("refused: {}: {}\n", row["file"].get<std::string>(), row["reason"].get<std::string>());
}

constexpr std::array kinds{"methods", "rows",    "engines", "perturbations", "environments", "suites", "scenarios",
                           "layouts", "presets", "sources", "axes",          "arms",         "kinds"};

std::vector<std::string> layouts_of_all(const Suite& suite) {
  std::vector<Scenario> scenarios;
  for (const std::string& id : suite.design.scenarios) scenarios.push_back(load_scenario(id));
  return common_layouts(scenarios);
}

bool answers(const std::string& source, const std::string& scenario) {
  try {
    check_recorded({source}, {scenario});
    return true;
  } catch (const InputError&) {
    return false;
  }
}

// Words of --answers, without recorded files that answer none of the scenarios.
std::vector<std::string> sources_of(const std::vector<std::string>& scenarios) {
  std::vector<std::string> words = answer_words(false);
  for (const std::string& source : recorded_sources())
    if (std::none_of(scenarios.begin(), scenarios.end(), [&](const std::string& id) { return answers(source, id); }))
      words.erase(std::find(words.begin(), words.end(), source));
  return words;
}

// Of arms, or of axes where they are perturbations' ids: those of the suites.
std::set<std::string> words_of_arms(const std::vector<Suite>& suites, bool axes) {
  std::set<std::string> found;
  for (const Suite& suite : suites) {
    const SuiteArms arms = arms_of(suite, suite.design);
    if (axes)
      for (const auto& axis : arms.axes) found.insert(axis.first);
    else
      found.insert(arms.ids.begin(), arms.ids.end());
  }
  return found;
}

std::set<std::string> preset_words(const std::vector<Suite>& suites) {
  std::set<std::string> found;
  for (const Suite& suite : suites)
    for (const auto& preset : suite.presets.items()) found.insert(preset.key());
  return found;
}

// Of a section of the listing; of scenarios, those of the suite's environment.
std::set<std::string> listed_words(const Json& section, const Suite* of) {
  std::set<std::string> found;
  for (const Json& row : section)
    if (!of || load_scenario(row.at("id")).environment->id() == of->environment) found.insert(row.at("id"));
  return found;
}

// Of --answers and --layout: those that a run of that suite or scenario takes; "": any.
std::vector<std::string> source_words(const std::string& of, bool of_suite) {
  if (of.empty()) return answer_words(false);
  return sources_of(of_suite ? load_suite(of).design.scenarios : std::vector{of});
}

std::vector<std::string> layout_words(const std::string& of, bool of_suite) {
  if (of.empty()) return installed_layouts();
  return of_suite ? layouts_of_all(load_suite(of)) : layouts_of(load_scenario(of));
}

// The words of one kind that options take: with `of`, those that a run of that suite or, of layouts, that scenario
// takes.
std::vector<std::string> words(const std::string& kind, const std::string& of, const Json& all) {
  const Json& shipped = all.at("suites");
  const bool of_suite =
      std::any_of(shipped.begin(), shipped.end(), [&of](const Json& suite) { return suite.at("id") == of; });
  if (kind == "kinds") return {kinds.begin(), kinds.end()};
  if (kind == "axes") return train_on_axes();
  if (kind == "sources") return source_words(of, of_suite);
  if (kind == "layouts") return layout_words(of, of_suite);
  std::vector<Suite> suites;
  if (!of.empty()) suites.push_back(load_suite(of));
  for (const Json& suite : of.empty() ? shipped : Json::array()) suites.push_back(load_suite(suite.at("id")));
  const bool arms = kind == "arms", axes = kind == "perturbations" && !of.empty();
  const Json& section = all.value(kind == "rows" ? "reference rows" : kind, Json());
  const Suite* const scenarios_of = of.empty() || kind != "scenarios" ? nullptr : &suites.front();
  const std::set<std::string> found = arms || axes        ? words_of_arms(suites, axes)
                                      : kind == "presets" ? preset_words(suites)
                                                          : listed_words(section, scenarios_of);
  return {found.begin(), found.end()};
}

}  // namespace

Json reference_rows() {
  Json all = Json::array();
  for (const ReferenceRow& row : lgabench::reference_rows())
    all.push_back({{"id", row.id}, {"summary", row.summary + (row.in_every_suite ? "" : " (suites that ask for it)")}});
  return all;
}

std::vector<std::string> common_layouts(const std::vector<Scenario>& scenarios) {
  std::vector<std::string> common = layouts_of(scenarios.front());
  for (const Scenario& one : scenarios) {
    const std::vector<std::string> there = layouts_of(one);
    common.erase(std::remove_if(common.begin(), common.end(),
                                [&there](const std::string& layout) { return !contains(there, layout); }),
                 common.end());
  }
  return common;
}

void add_list(CLI::App& app, int& exit) {
  struct ListArguments {
    bool json = false, is_short = false;
    std::string kind, of, python = usual_python();
    std::vector<fs::path> directories;
  };
  const auto arguments = std::make_shared<ListArguments>();
  Verb verb(
      app, "list",
      "List methods, engines, perturbations, environments, suites and scenarios, and any plugins that were refused");
  verb.option("KIND", arguments->kind,
              fmt::format("Print only the names of one kind, one per line: {}", fmt::join(kinds, ", ")),
              one_of("kind", {kinds.begin(), kinds.end()}));
  verb.option("--of SUITE", arguments->of,
              "With KIND: only names that a run of this suite accepts; for layouts and sources, a scenario's too");
  verb.option("--short", arguments->is_short, "Print one line for each entry: its id and a short title");
  verb.option("--json", arguments->json, "Print one JSON object");
  add_plugin_path(verb, arguments->directories, any_plugin);
  add_python(verb, arguments->python);
  add_scenario_path(verb);
  verb->footer(
      "Examples\n  lgabench list --short\n  lgabench list suites --short\n  lgabench list layouts --of fetch_fruit\n"
      "  lgabench list --plugin-path my/build");
  verb->callback([arguments, &exit] {
    const Json all = listing(plugins_at(arguments->directories, arguments->python),
                             arguments->json || (arguments->is_short && arguments->kind == "scenarios"));
    if (arguments->kind.empty() && !arguments->of.empty()) throw InputError("--of: expected a KIND with it");
    const std::string& kind = arguments->kind;
    const bool is_section = kind.empty() || kind == "rows" ||
                            std::find(std::begin(sections), std::end(sections), kind) != std::end(sections);
    if (arguments->is_short && (!is_section || !arguments->of.empty() || arguments->json))
      throw InputError("--short: expected no --of and no --json, and of kinds one of those that list prints");
    if (!kind.empty() && !arguments->is_short)
      to_stdout("{}\n", fmt::join(words(kind, arguments->of, all), "\n"));
    else if (arguments->json)
      to_stdout("{}\n", all.dump(2));
    else
      print_list(all, kind, arguments->is_short);
    exit = ok;
  });
}

}  // namespace lgabench::cli
