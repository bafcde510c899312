// lgabench check-scenario FILE.json: whether a scenario can be shown and solved, before a run depends on it.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/reference_actor.hpp>
#include <lgabench/cli/commands.hpp>
#include <lgabench/cli/findings.hpp>
#include <lgabench/cli/gallery.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/counted_progress.hpp>
#include <lgabench/harness/missing_encoder.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/harness/suite_scenario.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/host/python_method.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench::cli {
namespace {

struct CheckScenarioArguments {
  std::string file, engine, suite, python = usual_python();
  std::vector<std::string> layouts;
  fs::path out;
  int scenes = 50;
  std::vector<fs::path> plugin_path;
};

// The file's scenario, or the one of that id.
Scenario scenario_of(const std::string& word) {
  const fs::path file = word;
  if (file.extension() != ".json") return load_scenario(word);
  if (std::error_code not_there; !fs::exists(file, not_there)) throw InputError(word + ": no such file");
  lgabench::add_scenario_path(fs::absolute(file).parent_path());  // a space of its own lies there too
  read_scenario(read_json(file), word);                           // which says why a file of another kind is none
  return load_scenario(file.stem().string());
}

struct Tally {
  int successes = 0;
  std::map<std::string, int> failures;  // word -> how often
};

Tally play(Environment& environment, const std::vector<TestScene>& scenes, const char* who) {
  Tally played;
  for (const Episode& e : evaluate(environment, scenes, reference_actor(who), [](int) {}))
    e.failure == failure::none ? ++played.successes : ++played.failures[e.failure];
  return played;
}

// In how many of the scenes another object than the goal shares the target's type or texture.
int with_near_misses(const std::vector<TestScene>& scenes) {
  return static_cast<int>(std::count_if(scenes.begin(), scenes.end(), [](const TestScene& test) {
    const SceneObject* target = test.scene.find(role::target);
    const auto& objects = test.scene.objects;
    return target && std::any_of(objects.begin(), objects.end(), [target](const SceneObject& o) {
             return o.role != role::target && o.role != role::goal &&
                    (o.object_type == target->object_type || o.texture == target->texture);
           });
  }));
}

// Whether the arm's file asks for objects that share a feature with the target, without their sharing alike.
bool is_hard(const Scenario& scenario, const std::string& arm) {
  for (const Json& test : scenario.json.value("tests", Json::array()))
    if (test.value("arm", "") == arm) return test.value("hard", false);
  return false;
}

// Scenes of one arm in one layout: sampled, then played by the oracle, then by whoever takes any object.
// @throws EngineError where the environment is at fault.
void judge_arm(const Scenario& scenario, const std::string& layout, const std::string& arm, int count,
               Environment& environment, CheckReport& report) {
  constexpr int crowd = 4;      // more things than these, the goal among them, may find no room
  constexpr int sampled = 500;  // scenes of a crowd, though fewer are played
  const std::string where = fmt::format("{}, {}", arm, layout);
  std::vector<TestScene> scenes;
  try {
    const auto scene = [&](int i) {
      return arm == "train" ? training_scene(scenario, layout, {}, 0, i) : test_scene(scenario, layout, arm, 0, i);
    };
    for (int i = 0; i < count; ++i) scenes.push_back({scene(i)});
    if (scenes.front().scene.objects.size() > crowd)
      for (int i = count; i < sampled; ++i) scene(i);
  } catch (const Error& e) {
    constexpr std::size_t most = 160;  // some hold a whole distribution
    const std::string reason = e.what();
    return report.problem(where, reason.size() > most ? reason.substr(0, most) + "..." : reason,
                          "let the sets of target, avoid and distractors leave objects to show, and room for them");
  }
  const Tally oracle = play(environment, scenes, "oracle");
  const Tally any = play(environment, scenes, "random_object");
  const int near = with_near_misses(scenes);
  const bool bites = 2 * near > count;
  const int shared = bites ? play(environment, scenes, "most_shared").successes : 0;
  std::string fault;
  for (const auto& [failure, times] : oracle.failures)
    if (100 * (count - oracle.successes) > 2 * count)
      fault += fmt::format("{}{} {}", fault.empty() ? "" : ", ", failure, times);
  report.judge(
      where,
      fault.empty() ? ""
                    : fmt::format("the oracle fails in {} of {} scenes: {}", count - oracle.successes, count, fault),
      fmt::format("the oracle succeeds in {} of {} scenes, any visible object in {}{}", oracle.successes, count,
                  any.successes, bites ? fmt::format(", what shares most in {}; near misses in {}", shared, near) : ""),
      "look at such scenes: lgabench render SCENARIO --arm ARM --layout LAYOUT --index N");
  if (any.successes * 10 > count * 9)
    report.note(where, "any visible object is right",
                "more distractors, or a narrower command, would test abstraction");
  if (bites && 4 * (shared - any.successes) > count)
    report.note(where,
                fmt::format("the object that shares most with the others is the target in {} of {} scenes, so the "
                            "command is hardly needed",
                            shared, count),
                fmt::format("give the arm \"near_miss\": true{}, and its objects share alike",
                            is_hard(scenario, arm) ? " in place of \"hard\"" : ""));
}

void judge_answers(const Scenario& scenario, CheckReport& report) {
  const RecordedLanguageModel recorded(scenario, recorded_source(scenario, "recorded"));
  bool all = true;
  for (int i = 0; i < static_cast<int>(scenario.commands.size()); ++i) all &= recorded.knows(scenario.command(i));
  if (all)
    report.ok("recorded answers", "for every command");
  else
    report.note("recorded answers", "not for every command",
                "ask a model (docs/language-models.md), or run methods that ask none with --answers none");
}

void judge_sentences(const Scenario& scenario, CheckReport& report) {
  const std::string missing = missing_encoder(scenario.utterances());
  if (missing.empty())
    report.ok("sentences", "every command can be read by a policy");
  else
    report.note("sentences", missing, "or run methods that see a mask alone, such as human");
}

int check_scenario(const CheckScenarioArguments& a) {
  std::optional<Suite> suite;
  if (!a.suite.empty()) suite = load_suite(a.suite);
  const auto in_suite = [&suite](const std::string& id) { return suite_scenario(*suite, id, Truth::released); };
  const bool is_file = fs::path(a.file).extension() == ".json";  // else an id, which may be a variant of the suite
  const Scenario scenario = !suite    ? scenario_of(a.file)
                            : is_file ? in_suite(scenario_of(a.file).id)
                                      : in_suite(a.file);
  const Catalogue catalogue = plugins_at(a.plugin_path, usual_python());
  const EnvironmentType& type = *scenario.environment;
  const std::string engine = a.engine.empty() ? default_engine(catalogue, type) : a.engine;
  const auto environment = make_environment(scenario, load_engine(catalogue.engine(engine, type)));
  CheckReport report;
  report.ok("file", fmt::format("{} in {}, {} command(s), {} arm(s)", scenario.task, scenario.environment->id(),
                                scenario.commands.size(), scenario.tests.size()));
  std::vector<std::string> arms{"train"};
  for (const Arm& arm : scenario.tests) arms.push_back(arm.id);
  std::vector<std::string> layouts = a.layouts;
  for (const std::string& layout : layouts) layout_of(scenario, layout);
  if (layouts.empty() && suite) layouts = suite->design.layouts;
  if (layouts.empty()) {
    layouts = layouts_of(scenario);
    layouts.resize(std::min<std::size_t>(layouts.size(), 2));
  }
  CountedProgress progress("arms checked:", static_cast<int>(layouts.size() * arms.size()));
  for (const std::string& layout : layouts)
    for (const std::string& arm : arms) {
      try {
        judge_arm(scenario, layout, arm, a.scenes, *environment, report);
      } catch (const EngineError& e) {
        report.problem(fmt::format("{}, {}", arm, layout), e.what(),
                       "environment and engine must keep to their interface");
      }
      progress.tell_next();
    }
  progress.end();
  judge_answers(scenario, report);
  judge_sentences(scenario, report);
  to_stdout("{}\n", scenario.id);
  if (!has_problem(report)) {
    const fs::path picture = a.out.empty() ? fs::path(scenario.id + ".png") : a.out;
    write_file(picture, scene_sheet(scenario, layouts.front()).png);
    report.ok("picture", picture.string());
  }
  print(report);
  return has_problem(report) ? regression : ok;
}

}  // namespace

void add_check_scenario(CLI::App& app, int& exit) {
  auto a = std::make_shared<CheckScenarioArguments>();
  Verb verb(app, "check-scenario", worker_summary("check-scenario"));
  verb.option("scenario FILE", a->file, "The scenario's file, or its id", required);
  verb.option("--scenes N", a->scenes, "Scenes per arm and layout", CLI::Range(1, 100000), with_default);
  verb.option("--layout LAYOUT,...", a->layouts,
              "Layouts of the task, separated by commas (default: those of --suite, else the task's first two)");
  verb.option("--suite SUITE", a->suite,
              "Check the scenario as this suite plays it, with its training scenes and arms");
  verb.option("--engine ENGINE", a->engine, "An engine, by plugin id (default: the one that suites use)");
  verb.option("--out FILE", a->out, "The file for the picture (default: SCENARIO.png)");
  add_plugin_path(verb, a->plugin_path, any_plugin);
  add_python(verb, a->python);
  add_scenario_path(verb);
  verb->footer("Exit 1 if there is a problem.\nExample: lgabench check-scenario round.json");
  verb->callback([a, &exit] { exit = check_scenario(*a); });
}

}  // namespace lgabench::cli
