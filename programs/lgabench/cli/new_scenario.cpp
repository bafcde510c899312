// lgabench new-scenario NAME: a researcher's own command, its truth and its scenes, as a file that runs take.
#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <memory>
#include <optional>

#include <lgabench/cli/new_scenario.hpp>
#include <lgabench/cli/own_names.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/missing_encoder.hpp>

namespace lgabench::cli {
namespace {

struct NewScenarioArguments : NewScenario {
  fs::path directory = ".";
};

// The flags are members of that environment's scenarios which has the default task.
CLI::Validator task_with_these_flags() {
  return CLI::Validator(
      [](std::string& word) {
        Words ids;
        for (const TaskInfo& task : environment_with_task(NewScenario().task).tasks()) ids.push_back(task.id);
        return one_of("task", ids)(word);
      },
      "", "");
}

// The words that a person types for what no flag gave, with commas between them where there may be several.
void ask(const char* verb, Words& words, const char* flag, const char* question, bool several) {
  if (!words.empty()) return;
  std::string line;
  if (::isatty(STDIN_FILENO)) {
    to_stderr("{} ", question);
    std::getline(std::cin, line);
  }
  if (line.empty()) throw InputError(fmt::format("{}: expected {}", verb, flag));
  words = several ? items_of(line, ',') : Words{line};
  for (std::string& word : words) CLI::detail::trim(word);
}

// "ALL", names, or "ALL but" names.
Json names_of(Words words) {
  const std::string but = "ALL but ";
  if (words == Words{"ALL"}) return "ALL";
  if (words.front().rfind(but, 0) != 0) return words;
  words.front().erase(0, but.size());
  return {{"except", words}};
}

Json set_of(const Words& types, const Words& textures) {
  return {{"object_types", names_of(types)}, {"textures", names_of(textures)}};
}

// Of TYPE,.../TEXTURE,...; without a slash of any texture.
Json set_of(const std::string& text) {
  const std::size_t slash = text.find('/');
  const auto names = [](const std::string& list) { return items_of(list, ','); };
  return set_of(names(text.substr(0, slash)), slash == text.npos ? Words{"ALL"} : names(text.substr(slash + 1)));
}

Json sets_of(const Words& texts) {
  Json sets = Json::array();
  for (const std::string& text : texts) sets.push_back(set_of(text));
  return sets;
}

Json meaning_of(const NewScenario& a) {
  if (a.rule.empty() && (!a.of.empty() || !a.order.empty()))
    throw InputError("--relative-to, --order: expected --which with them");
  const Json product = set_of(a.types, a.textures);
  if (a.also.empty() && a.rule.empty()) return product;
  Json meaning{{"sets", {product}}};
  for (const std::string& text : a.also) meaning["sets"].push_back(set_of(text));
  if (!a.rule.empty()) meaning["which"] = {{"rule", a.rule}};
  if (!a.of.empty()) meaning["which"]["of"] = set_of(a.of);
  if (!a.order.empty()) meaning["which"]["order"] = a.order;
  return meaning;
}

Json range_of(const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto fewest = number_of<int>(text.substr(0, colon)),
             most = number_of<int>(colon == std::string::npos ? text : text.substr(colon + 1));
  if (!fewest || !most)
    throw InputError(fmt::format("--distractors: expected FEWEST:MOST, such as 1:2, got \"{}\"", text));
  return {*fewest, *most};
}

Json scenario_json(const NewScenario& a) {
  if (a.other_types.empty() && a.other_textures != NewScenario().other_textures)
    throw InputError("--other-textures: expected --other-types with it");
  Json truth{{"target", meaning_of(a)}};
  const EnvironmentType& environment = environment_with_task(a.task);
  const std::optional<SecondRole>& second = find_task(environment, a.task).second;
  if (!a.other_types.empty()) {
    if (!second) throw InputError(fmt::format("--other-types: {} has no other objects than its target", a.task));
    truth[second->id] = set_of(a.other_types, a.other_textures);
  }
  Json commands = Json::array();
  for (const std::string& utterance : a.commands) commands.push_back({{"utterance", utterance}, {"truth", truth}});
  for (const std::string& utterance : a.unseen)
    commands.push_back({{"utterance", utterance}, {"truth", truth}, {"seen", false}});
  const Json distractors = range_of(a.distractors);
  Json tests = Json::array({{{"arm", "test"}, {"distractors", distractors}}});
  if (a.hard) tests.push_back({{"arm", "hard"}, {"distractors", distractors}, {"hard", true}});
  // As in the shipped suites: with fewer any object is right too often. Only these scenes have room for them.
  const bool has_room = a.task == "pick_and_place" && a.distractors == NewScenario().distractors;
  if (a.near_miss)
    tests.push_back(
        {{"arm", "near_miss"}, {"distractors", has_room ? range_of("4:4") : distractors}, {"near_miss", true}});
  if (!a.unseen.empty()) tests.push_back({{"arm", "unseen"}, {"distractors", distractors}, {"unseen", true}});
  Json json{{"id", a.name},         {"environment", environment.id()},
            {"task", a.task},       {"feature_space", a.space.empty() ? environment.spaces().front() : a.space},
            {"commands", commands}, {"tests", tests}};
  if (a.angle_deg) json["angle_deg"] = *a.angle_deg;
  if (a.clockwise) json["direction"] = "clockwise";
  if (!a.careless.empty()) json["near_miss_sets"] = sets_of(a.careless);
  if (!a.words.empty()) json["words"] = set_of(a.words);
  if (!a.undecided.empty()) json["undecided"] = sets_of(a.undecided);
  if (!a.also.empty() || !a.careless.empty() || !a.rule.empty())
    json["train"] = {{"as_method_asks", false}, {"distractors", distractors}};
  return json;
}

void new_scenario(NewScenarioArguments a) {
  expect_plain_name("new-scenario", a.name);
  const fs::path file = (a.directory / (a.name + ".json")).lexically_normal();
  if (std::error_code error; fs::exists(file, error))
    throw InputError(fmt::format("{}: exists already; nothing was written", file.string()));
  expect_free_scenario("new-scenario", a.name);
  expect_scenario_path(a.directory);
  const Json json = new_scenario_json(a, "new-scenario", file.string());
  write_file(file, json.dump(1) + "\n");
  to_stdout("{}\n\nTo sample it, let the oracle play it, and draw it:\n  lgabench check-scenario {}\n", file.string(),
            path_word(file));
  to_stdout(
      "To run it:\n  lgabench run q1 --preset smoke --scenarios {} --scenario-path {} --answers none --methods "
      "human,gcbc_seg\n",
      a.name, path_word(fs::weakly_canonical(a.directory)));
  Words commands = a.commands;
  commands.insert(commands.end(), a.unseen.begin(), a.unseen.end());
  if (const std::string missing = missing_encoder(commands); !missing.empty()) to_stdout("\nFirst: {}\n", missing);
}

}  // namespace

Json new_scenario_json(NewScenario& a, const char* verb, const std::string& file) {
  ask(verb, a.commands, "--command TEXT", "What is the command?", false);
  ask(verb, a.types, "--types", "Which object types does it mean? (with commas between them, or ALL)", true);
  const Json json = scenario_json(a);
  read_scenario(json, file);  // the reader of runs judges what was given
  return json;
}

void add_scenario_options(Verb& verb, NewScenario& a) {
  verb.below("The command");
  verb.option("--command TEXT", a.commands, "The command's words; asked for if left out; can be repeated", repeatable);
  verb.option("--unseen TEXT", a.unseen, "A command that is tested but never demonstrated; can be repeated",
              repeatable);
  verb.option("--types TYPE,...", a.types,
              "Object types that the command means, ALL, or \"ALL but TYPE,...\"; asked for if left out", repeatable);
  verb.option("--textures TEXTURE,...", a.textures, "Their textures, ALL, or \"ALL but TEXTURE,...\"", repeatable);
  verb.option("--also SET", a.also,
              "Another set that it means: TYPE,.../TEXTURE,..., or TYPE,... of any texture; can be repeated",
              repeatable);
  verb.option("--which RULE", a.rule,
              "Which one of several objects it means: leftmost, rightmost, left_of, right_of, nearest_to, "
              "farthest_from or first_in");
  verb.option("--relative-to SET", a.of,
              "left_of, right_of, nearest_to, farthest_from: the other object, TYPE,.../TEXTURE,...");
  verb.option("--order NAME,...", a.order, "first_in: object types or textures; the first of them wins", repeatable);
  verb.option("--words SET", a.words, "The set that the words alone mean, if the person takes less of it");
  verb.option("--other-types TYPE,...", a.other_types, "Object types that a sweep must not touch", repeatable);
  verb.option("--other-textures TEXTURE,...", a.other_textures, "Their textures, or ALL", repeatable);
  verb.option("--space SPACE", a.space,
              "The feature space, whose words you may use; lgabench render --gallery objects draws them (default: the "
              "usual one of the task's environment)",
              feature_space());
  verb.below("The task and its scenes");
  verb.option("--task TASK", a.task, "What to do with the object", task_with_these_flags(), with_default);
  verb.option("--angle DEGREES", a.angle_deg, "rotate: by how much, in degrees");
  verb.option("--clockwise", a.clockwise, "rotate: clockwise, seen from above");
  verb.option("--distractors N:M", a.distractors, "Number of other objects in a test scene", with_default);
  verb.option("--hard", a.hard, "Add an arm where a distractor shares the target's type or texture");
  verb.option("--near-miss", a.near_miss,
              "Add an arm of near misses: all other objects share the target's type or texture, and each other's");
  verb.option("--careless SET", a.careless,
              "A set that a careless reading keeps, TYPE,.../TEXTURE,...: each test scene shows one; can be repeated",
              repeatable);
  verb.option("--undecided SET", a.undecided,
              "A set that people disagree on, TYPE,.../TEXTURE,...: no scene shows it; can be repeated", repeatable);
}

void add_new_scenario(CLI::App& app, int& exit) {
  auto a = std::make_shared<NewScenarioArguments>();
  Verb verb(app, "new-scenario", "Write a scenario of your own: a command, its meaning, its scenes");
  verb.option("name NAME", a->name, "The scenario's id, and the name of its file", required);
  verb.option("--directory DIR", a->directory, "The directory for the file", with_default);
  add_scenario_options(verb, *a);
  verb->footer(
      "docs/own-scenarios.md says more; docs/formats has every member of the file.\n"
      "Example: lgabench new-scenario round --command \"Bring me something round.\" --types round,ring");
  verb->callback([a, &exit] {
    new_scenario(*a);
    exit = ok;
  });
}

}  // namespace lgabench::cli
