#include <lgabench/core/scenario.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <functional>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/read_space.hpp>
#include <lgabench/core/scenario_files.hpp>
#include <lgabench/core/shipped.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench {
namespace {

constexpr int most_wordings = 99;
constexpr const char* plain_name = "a name of at most 64 letters, digits, '_', '-' and '.', no '-' first";

bool is_plain(const std::string& name) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
  };
  return !name.empty() && name.size() <= 64 && name[0] != '-' && std::all_of(name.begin(), name.end(), plain);
}

// What the environment says of one of the file's words, with the place of that word.
template <class Find>
auto& named(const JsonReader& reader, Find find) {
  try {
    return find(reader.string());
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}: {}", reader.file(), reader.place(), e.what()));
  }
}

ScenarioCommand read_command(const JsonReader& reader, const Scenario& scenario) {
  reader.only({"utterance", "truth", "seen", "arm", "ambiguous", "wording"});
  ScenarioCommand command{reader.at("utterance").string(),
                          read_distribution(reader.at("truth"), scenario.space, scenario.second)};
  expect_possible(command.truth.target, reader.at("truth").at("target"));
  command.truth.provenance = Provenance::truth;
  command.truth.source = "true distribution";
  command.truth.asked_as = command.utterance;
  if (scenario.second && !command.truth.second)
    reader.at("truth").fail(fmt::format("\"{}\" for {}", scenario.second->id, scenario.task));
  if (reader.has("seen")) command.seen = reader.at("seen").boolean();
  if (reader.has("arm")) command.arm = reader.at("arm").string();
  if (reader.has("arm") && command.seen) reader.at("arm").fail("\"seen\": false beside it");
  if (reader.has("ambiguous")) command.ambiguous = reader.at("ambiguous").boolean();
  if (reader.has("wording")) command.wording = static_cast<int>(reader.at("wording").integer(1, most_wordings));
  if (command.wording > 0 && (command.seen || !command.arm.empty()))
    reader.at("wording").fail("\"seen\": false and no \"arm\" beside it");
  if (command.ambiguous && command.arm.empty() && command.wording == 0)
    reader.at("ambiguous").fail("\"arm\" or \"wording\" beside it");
  return command;
}

// Other words for one command mean what it means, so that its scenes are theirs.
void expect_wordings(const JsonReader& commands, const Scenario& scenario) {
  const std::vector<JsonReader> all = commands.elements();
  std::vector<int> seen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ScenarioCommand& command = scenario.commands[i];
    if (command.wording == 0) continue;
    if (scenario.commands_of("train") != std::vector<int>{0})
      all[i].at("wording").fail("the first command as the only seen one");
    if (std::count(seen.begin(), seen.end(), command.wording) > 0) all[i].at("wording").fail("each level once");
    if (distribution_json(command.truth) != distribution_json(scenario.commands.front().truth))
      all[i].at("truth").fail("the truth of the first command, which this one rewords");
    seen.push_back(command.wording);
  }
}

// Words that answers can be recorded for; those that an arm's axis gives may be none. An unseen command is not one that
// is demonstrated.
void expect_words(const JsonReader& commands, const Scenario& scenario) {
  const std::vector<JsonReader> all = commands.elements();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ScenarioCommand& command = scenario.commands[i];
    const std::string& words = command.utterance;
    if (one_line(words) != words || (words.empty() && command.arm.empty()))
      all[i].at("utterance").fail("words, in a line");
    const auto demonstrated = [&words](const ScenarioCommand& one) { return one.seen && one.utterance == words; };
    if (!command.seen && command.arm.empty() &&
        std::any_of(scenario.commands.begin(), scenario.commands.end(), demonstrated))
      all[i].at("utterance").fail("other words than those of a command that is demonstrated");
  }
}

// What the arm's axis gives in place of its commands; none where it leaves them.
std::vector<std::string> words_of(const Arm& arm) {
  for (const PerturbationAxis* axis : arm.axes)
    if (axis->words) return axis->words(arm.perturbation->level);
  return {};
}

// Of the test arms, the one that a command names. Where its axis gives commands, these mean nothing.
void expect_arms(const JsonReader& commands, const Scenario& scenario) {
  std::vector<std::string> unseen;
  for (const Arm& arm : scenario.tests)
    if (arm.unseen) unseen.push_back(arm.id);
  const std::vector<JsonReader> all = commands.elements();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ScenarioCommand& command = scenario.commands[i];
    const auto gives = [&](const Arm& arm) { return arm.id == command.arm && !words_of(arm).empty(); };
    const bool added = std::any_of(scenario.tests.begin(), scenario.tests.end(), gives);
    if (all[i].has("arm") && !added && std::count(unseen.begin(), unseen.end(), command.arm) == 0)
      all[i].at("arm").fail(fmt::format("an arm with \"unseen\": true ({})", fmt::join(unseen, ", ")));
    if (command.truth.target.empty() != added)
      all[i].at("truth").fail(added ? "an empty set: these words have no meaning"
                                    : "at least one object type and one texture");
  }
}

// Adds what the arms' axes give, but what is there: the scenario was written with it. Answers are those of the words
// alone: looked up by the scenario, they would be the same whatever is said.
void add_words(Scenario& scenario) {
  if (!instructing_axis(scenario)) return;
  scenario.json["answers_of"] = scenario.answers_of = "";
  const Json nothing{{"target", {{"object_types", Json::array()}, {"textures", Json::array()}}}};
  for (const Arm& arm : scenario.tests) {
    const auto is_there = [&arm](const ScenarioCommand& command) { return command.arm == arm.id; };
    if (std::any_of(scenario.commands.begin(), scenario.commands.end(), is_there)) continue;
    for (const std::string& utterance : words_of(arm)) {
      scenario.json["commands"].push_back(
          {{"utterance", utterance}, {"truth", nothing}, {"seen", false}, {"arm", arm.id}});
      const JsonReader added(scenario.json["commands"].back(), scenario.id);
      scenario.commands.push_back(read_command(added, scenario));
    }
  }
}

// The first arm is what others are compared with.
void expect_played(const JsonReader& list, const Scenario& scenario) {
  const std::vector<std::string> played = list.strings();
  for (const JsonReader& one : list.elements())
    if (std::none_of(scenario.tests.begin(), scenario.tests.end(),
                     [&](const Arm& arm) { return arm.id == one.string(); }))
      one.fail("an arm of \"tests\"");
  if (std::count(played.begin(), played.end(), scenario.tests.front().id) == 0) list.fail("the first arm among them");
}

double read_probability(const JsonReader& reader) {
  const double p = reader.number();
  if (!(p >= 0 && p <= 1)) reader.fail("a probability");
  return p;
}

// With what the environment's own members are read by.
Arm read_arm(const JsonReader& reader, std::vector<std::string> members, const PluginAxes& axes,
             const std::function<std::shared_ptr<const SceneContent>()>& read_content) {
  members.insert(members.end(), {"arm", "unseen", "label_noise", "missed_segment", "perturbation"});
  reader.only(members);
  Arm arm;
  arm.id = reader.at("arm").string();
  if (!is_plain(arm.id)) reader.at("arm").fail(plain_name);
  if (arm.id == "train") reader.at("arm").fail("another name than train");
  arm.scenes = read_content();
  if (reader.has("unseen")) arm.unseen = reader.at("unseen").boolean();
  if (reader.has("label_noise")) arm.label_noise = read_probability(reader.at("label_noise"));
  if (reader.has("missed_segment")) arm.missed_segment = read_probability(reader.at("missed_segment"));
  if (reader.has("perturbation")) arm.perturbation = read_perturbation(reader.at("perturbation"), axes);
  return arm;
}

// An arm is compared with its control scene by scene, so that nothing else may differ.
void expect_control(const JsonReader& file, const JsonReader& arm) {
  Json control = file.at("tests").elements().front().json(), same = arm.json();
  if (control.contains("perturbation")) arm.at("perturbation").fail("a first arm without a perturbation, its control");
  for (const char* member : {"arm", "perturbation"}) {
    control.erase(member);
    same.erase(member);
  }
  if (control != same) arm.at("perturbation").fail("the other members of the first arm, its control");
}

// The axes of an arm's perturbation, and what of its command they change.
void read_change(const JsonReader& arm, const Scenario& scenario, Arm& read) {
  if (const std::string lack = lacking(scenario, *read.perturbation); !lack.empty())
    throw InputError(
        fmt::format("{}: {}: {}: {}", arm.file(), arm.at("perturbation").place(), read.perturbation->axis, lack));
  read.axes = axes_of(scenario, *read.perturbation);
  for (const PerturbationAxis* axis : read.axes)
    if (axis->rewords) read.wording = read.perturbation->level;
}

// Those of plugins that arms have, and no others: what they declare is part of the scenario.
void keep_axes_of_arms(Scenario& scenario) {
  PluginAxes& axes = scenario.axes;
  const auto is_of_no_arm = [&scenario](const auto& axis) {
    return std::none_of(scenario.tests.begin(), scenario.tests.end(),
                        [&axis](const Arm& arm) { return arm.perturbation && arm.perturbation->axis == axis->id; });
  };
  axes.erase(std::remove_if(axes.begin(), axes.end(), is_of_no_arm), axes.end());
  scenario.json.erase("axes");
  for (const auto& axis : axes) scenario.json["axes"][axis->id] = axis_json(*axis);
}

void read_train(const JsonReader& file, std::vector<std::string> members, const EnvironmentType& environment,
                Scenario& scenario) {
  if (!file.has("train")) {
    scenario.train = environment.read_content(scenario, file, nullptr, true);
    return;
  }
  const JsonReader reader = file.at("train");
  members.emplace_back("as_method_asks");
  reader.only(members);
  if (reader.has("as_method_asks")) scenario.as_method_asks = reader.at("as_method_asks").boolean();
  scenario.train = environment.read_content(scenario, file, &reader, true);
}

// Whose answers are the scenario's recorded ones, and which of them are given to people.
void read_answers(const JsonReader& reader, Scenario& scenario) {
  reader.only({"recorded", "edited"});
  const std::vector<std::string>& known = shipped_answers();
  const auto file = [&known](const JsonReader& name) {
    if (!contains(known, name.string())) name.fail(fmt::format("one of: {}", fmt::join(known, ", ")));
    return name.string();
  };
  scenario.recorded = file(reader.at("recorded"));
  scenario.edited = reader.has("edited") ? file(reader.at("edited")) : scenario.recorded;
}

// The file's members with the appendix's in place of the released ones.
Json as_printed(Json json) {
  const Json printed = json.value("printed", Json());
  if (printed.is_null()) return json;
  json.erase("printed");
  json.update(printed);
  json["truth"] = "printed";
  return json;
}

}  // namespace

Truth read_truth(const std::string& word) {
  if (word == "released") return Truth::released;
  if (word == "printed") return Truth::printed;
  throw InputError(fmt::format("truth: expected released or printed, got \"{}\"", word));
}

Scenario read_scenario(const Json& json, const std::string& file) {
  const JsonReader reader(json, file);
  Scenario s;
  s.id = reader.at("id").string();
  const EnvironmentType& environment = named(reader.at("environment"), find_environment);
  s.environment = &environment;
  const TaskInfo& task =
      named(reader.at("task"), [&](const std::string& id) -> const TaskInfo& { return find_task(environment, id); });
  s.task = task.id;
  s.second = task.second;
  const std::vector<std::string> of_task = environment.scenario_members(task),
                                 of_scenes = environment.scene_members(task);
  std::vector<std::string> members = of_task;
  members.insert(members.end(),
                 {"id", "environment", "task", "feature_space", "commands", "answers_of", "answers", "train", "tests",
                  "played", "questions", "may_stop", "axes", "truth", "printed", "note"});
  reader.only(members);
  if (reader.has("printed")) {
    std::vector<std::string> replaced = of_task;
    replaced.insert(replaced.end(), {"commands", "note"});
    reader.at("printed").only(replaced);
  }
  s.space = read_space(reader.at("feature_space"));
  for (const JsonReader& command : reader.at("commands").elements()) s.commands.push_back(read_command(command, s));
  if (s.commands_of("train").empty()) reader.at("commands").fail("at least one seen command");
  expect_words(reader.at("commands"), s);
  expect_wordings(reader.at("commands"), s);
  s.answers_of = reader.has("answers_of") ? reader.at("answers_of").string() : s.id;
  if (reader.has("answers")) read_answers(reader.at("answers"), s);
  read_train(reader, of_scenes, environment, s);
  if (reader.has("questions")) {
    constexpr int most_scenes = 100;
    const JsonReader questions = reader.at("questions");
    questions.only({"scenes", "errs"});
    s.questions = Scenario::Questions{static_cast<int>(questions.at("scenes").integer(1, most_scenes)),
                                      read_probability(questions.at("errs"))};
  }
  if (reader.has("may_stop")) s.may_stop = reader.at("may_stop").boolean();
  if (s.may_stop && task.most_steps == 1 && !contains(of_task, "may_stop"))  // a task of one step may know it, too
    reader.at("may_stop").fail("a task of several steps");
  s.axes = read_plugin_axes(reader);
  for (const JsonReader& arm : reader.at("tests").elements()) {
    s.tests.push_back(
        read_arm(arm, of_scenes, s.axes, [&] { return environment.read_content(s, reader, &arm, false); }));
    const auto same = [&](const Arm& other) { return other.id == s.tests.back().id; };
    if (std::count_if(s.tests.begin(), s.tests.end(), same) > 1) arm.at("arm").fail("each arm once");
    if (s.tests.back().perturbation) {
      expect_control(reader, arm);
      expect_shown(arm.at("perturbation"), axes_named(s.tests.back().perturbation->axis, s.axes), environment.id(),
                   environment.has_views());
      read_change(arm, s, s.tests.back());
    }
    if (s.commands_of(s.tests.back().id).empty()) arm.fail("a scenario with commands for this arm");
  }
  expect_arms(reader.at("commands"), s);
  if (s.tests.empty()) reader.at("tests").fail("at least one arm");
  if (reader.has("played")) expect_played(reader.at("played"), s);
  s.json = json;
  keep_axes_of_arms(s);
  add_words(s);
  return s;
}

std::vector<std::string> played_arms(const Json& scenario) {
  const JsonReader reader(scenario, "scenario");
  if (reader.has("played")) return reader.at("played").strings();
  std::vector<std::string> all;
  for (const JsonReader& arm : reader.at("tests").elements()) all.push_back(arm.at("arm").string());
  return all;
}

std::vector<std::string> Scenario::utterances() const {
  std::vector<std::string> all;
  for (const ScenarioCommand& command : commands) all.push_back(command.utterance);
  return all;
}

const Arm& Scenario::arm(const std::string& name) const {
  for (const Arm& test : tests)
    if (test.id == name) return test;
  throw InputError(fmt::format("arm \"{}\": expected train or a test arm of scenario \"{}\"", name, id));
}

std::vector<int> Scenario::commands_of(const std::string& name) const {
  const int wording = name == "train" ? 0 : arm(name).wording;
  const bool seen = name == "train" || (!arm(name).unseen && wording == 0);
  std::vector<int> indices;
  for (std::size_t i = 0; i < commands.size(); ++i)
    if (commands[i].seen == seen && commands[i].wording == wording &&
        (commands[i].arm.empty() || commands[i].arm == name))
      indices.push_back(static_cast<int>(i));
  return indices;
}

bool Scenario::is_ambiguous(const std::string& name) const {
  const std::vector<int> given = commands_of(name);
  return std::any_of(given.begin(), given.end(),
                     [this](int command) { return commands[static_cast<std::size_t>(command)].ambiguous; });
}

int Scenario::training_scenes(int demonstrations) const {
  return demonstrations * static_cast<int>(commands_of("train").size());
}

std::vector<std::string> scenario_ids() {
  std::vector<std::string> ids;
  for (const auto& [id, file] : scenario_files()) ids.push_back(id);
  return ids;
}

Scenario load_scenario(const std::string& id, Truth truth) {
  const fs::path file = scenario_file(id);
  if (file.empty()) throw InputError(none_named("scenario", id, scenario_ids()));
  const Json json = read_shipped_json(file);
  Scenario s = read_scenario(truth == Truth::printed ? as_printed(json) : json, file.string());
  if (!is_plain(s.id)) JsonReader(json, file.string()).at("id").fail(plain_name);
  if (s.id != id)
    throw InputError(
        fmt::format("{}: /id: expected \"{}\", as the file is named, got \"{}\"", file.string(), id, s.id));
  return s;
}

}  // namespace lgabench
