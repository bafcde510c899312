// lgabench new-suite NAME: a question of a researcher's own, as a suite that runs take: scenarios, words, claims.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include <lgabench/cli/new_scenario.hpp>
#include <lgabench/cli/own_names.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/answers.hpp>
#include <lgabench/harness/missing_encoder.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench::cli {
namespace {

struct NewSuiteArguments {
  NewScenario scenario;  // its name: the suite's
  std::string title, question;
  Words scenarios;
  fs::path directory;
};

constexpr const char *truth = "human", *no_abstraction = "gcbc_seg";

// What is in view in an arm of that name, as `new-scenario` makes them.
std::string arm_words(const std::string& arm) {
  static const std::map<std::string, std::string> known{
      {"test", "the target, and objects that do not satisfy the command"},
      {"hard", "one of the other objects shares the target's type or texture"},
      {"near_miss", "all other objects share the target's type or texture, and each other's"},
      {"unseen", "a command that nobody demonstrated"}};
  const auto found = known.find(arm);
  return found == known.end() ? "scenes of the arm " + arm : found->second;
}

bool has_answers(const std::vector<std::string>& scenarios) {
  try {
    check_recorded({}, scenarios);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

// One that all have: the continuous one where it is among them.
std::string layout_of(const std::vector<Scenario>& scenarios) {
  const std::vector<std::string> common = common_layouts(scenarios);
  if (common.empty()) throw InputError("--scenarios: expected scenarios that have a layout in common");
  return contains(common, "continuous") ? "continuous" : common.front();
}

Json suite_json(const NewSuiteArguments& a, const std::vector<Scenario>& scenarios, bool answered) {
  Json ids = Json::array(), arms = Json::object(), titles = Json::object();
  for (const Scenario& one : scenarios) {
    ids.push_back(one.id);
    for (const Arm& arm : one.tests) {
      arms[arm.id] = arm_words(arm.id);
      std::string title = arm.id;
      std::replace(title.begin(), title.end(), '_', ' ');
      titles[arm.id] = std::move(title);
    }
  }
  Json methods{truth, no_abstraction};
  if (answered) methods.insert(methods.begin(), "lga");
  return {{"id", a.scenario.name},
          {"about",
           {{"title", a.title},
            {"question", a.question},
            {"main_arm", scenarios.front().tests.front().id},
            {"arms", arms},
            {"arm_titles", titles}}},
          {"environment", scenarios.front().environment->id()},
          {"scenarios", ids},
          {"layouts", {layout_of(scenarios)}},
          {"engines", {default_engine(scan_plugins(plugin_directories()), *scenarios.front().environment)}},
          {"methods", methods},
          {"demonstrations", {5, 20}},
          {"seeds", {0, 1, 2}},
          {"episodes", 50},
          {"scene_seed", 0},
          {"options", {{"*", {{"policy", "heat_map"}}}}},
          {"presets", {{"smoke", {{"demonstrations", {5}}, {"seeds", {0}}, {"episodes", 20}, {"smoke", true}}}}}};
}

Json claims_json() {
  return {{"note", "Said before the suite was run."},
          {"claims",
           {{{"id", "abstraction_helps"},
             {"statement",
              "A policy that sees the objects which the command means succeeds more often than one that sees all."},
             {"refuted_if", "it succeeds less often"},
             {"test", "ordering"},
             {"above", truth},
             {"below", no_abstraction}}}}};
}

void new_suite(NewSuiteArguments a) {
  expect_plain_name("new-suite", a.scenario.name);
  expect_free_suite("new-suite", a.scenario.name);
  for (const auto& [option, text] : {std::pair("--title", &a.title), std::pair("--question", &a.question)})
    if (one_line(*text) != *text)
      throw InputError(fmt::format("{}: expected one line of text in UTF-8, got \"{}\"", option, one_line(*text)));
  const fs::path directory = a.directory.empty() ? fs::path(a.scenario.name) : a.directory;
  const std::string name = a.scenario.name, file = name + ".json";
  if (std::error_code error; fs::exists(directory, error))
    throw InputError(fmt::format("{}: exists already; nothing was written", directory.string()));
  expect_scenario_path(directory);
  std::vector<Scenario> scenarios;
  std::map<fs::path, Json> files;
  for (const std::string& id : a.scenarios) scenarios.push_back(load_scenario(id));
  if (scenarios.empty() || !a.scenario.commands.empty()) {
    a.scenario.name += "_1";
    expect_plain_name("new-suite", a.scenario.name);
    expect_free_scenario("new-suite", a.scenario.name);
    const std::string scenario_file = a.scenario.name + ".json";
    const Json json = files[scenario_file] = new_scenario_json(a.scenario, "new-suite", scenario_file);
    scenarios.push_back(read_scenario(json, scenario_file));
    a.scenario.name = name;
  }
  for (const Scenario& one : scenarios)
    if (one.environment != scenarios.front().environment)
      throw InputError("--scenarios: expected scenarios of one environment");
  const bool answered = files.empty() && has_answers(a.scenarios);
  if (a.title.empty()) a.title = name;
  if (a.question.empty()) a.question = "How much does a policy gain that sees only what the command means?";
  files[file] = suite_json(a, scenarios, answered);
  files[fs::path("claims") / file] = claims_json();
  std::map<fs::path, std::string> texts;  // all of them before the first is written
  for (const auto& [to, json] : files) texts[to] = json.dump(1) + "\n";
  for (const auto& [to, text] : texts) {
    write_file(directory / to, text);
    to_stdout("{}\n", (directory / to).string());
  }
  load_suite((directory / file).string());  // the reader of runs judges what was written
  const std::string answers = answered ? "" : " --answers none";
  to_stdout(
      "\nTo run it, a first look and whole, and to test its claims:\n  lgabench run {0} --preset smoke{1}\n"
      "  lgabench run {0}{1} --out runs/{2}\n  lgabench report runs/{2} --claims\n",
      path_word(directory / file), answers, name);
  to_stdout("Another scenario for it: lgabench new-scenario NAME --directory {}, and its id below \"scenarios\"\n",
            path_word(directory));
  Words commands;
  for (const Scenario& one : scenarios)
    for (const std::string& utterance : one.utterances()) commands.push_back(utterance);
  if (const std::string missing = missing_encoder(commands); !missing.empty()) to_stdout("\nFirst: {}\n", missing);
}

}  // namespace

void add_new_suite(CLI::App& app, int& exit) {
  auto a = std::make_shared<NewSuiteArguments>();
  Verb verb(app, "new-suite", "Write a suite of your own: scenarios, a question, a preset smoke, a claim");
  verb.option("name NAME", a->scenario.name, "The suite's id; its own scenario is NAME_1", required);
  verb.option("--directory DIR", a->directory, "The suite's directory (default: ./NAME); it must not exist yet");
  verb.option("--title TEXT", a->title, "The suite's title on pages (default: NAME)");
  verb.option("--question TEXT", a->question, "The question that the suite asks");
  verb.option("--scenarios SCENARIO,...", a->scenarios,
              "Existing scenarios; without them, or with --command, new-suite writes one of the suite's own");
  add_scenario_options(verb, a->scenario);
  verb->footer(
      "new-suite writes the suite's own scenario as `new-scenario` does. The rows are the truth; GCBC-SEG, which sees "
      "all; and LGA, if answers are recorded for all scenarios. Without --distractors, a scene of near misses has four "
      "of them.\n"
      "Examples\n"
      "  lgabench new-suite round_things --command \"Bring me something round.\" --types round,ring --hard\n"
      "  lgabench new-suite my_suite --title \"Hearts and letters\" --scenarios heart,letter");
  verb->callback([a, &exit] {
    new_suite(*a);
    exit = ok;
  });
}

}  // namespace lgabench::cli
