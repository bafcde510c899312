#include <lgabench/drawn/draw.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>

namespace lgabench::drawn {
namespace {

// What meanings of this kind are shown in.
constexpr const char *task = "pick_and_place", *layout = "continuous";
std::string environment() { return environment_with_task(task).id(); }

// "ALL", or what is shorter to read: the names, or those that are left out.
Json names_of(const std::vector<std::string>& names, const std::vector<std::string>& space) {
  if (names == space) return "ALL";
  if (3 * names.size() <= 2 * space.size()) return names;
  std::vector<std::string> others;
  for (const std::string& name : space)
    if (!contains(names, name)) others.push_back(name);
  return {{"except", others}};
}

Json set_of(const FeatureSet& set, const FeatureSpace& space) {
  return {{"object_types", names_of(set.object_types, space.object_types)},
          {"textures", names_of(set.textures, space.textures)}};
}

Json sets_of(const std::vector<FeatureSet>& sets, const FeatureSpace& space) {
  Json all = Json::array();
  for (const FeatureSet& set : sets) all.push_back(set_of(set, space));
  return all;
}

Json meaning_of(const Meaning& meaning, const FeatureSpace& space) {
  if (meaning.is_product()) return set_of(meaning.product(), space);
  Json json{{"sets", sets_of(meaning.sets, space)}};
  if (!meaning.which) return json;
  json["which"] = to_json(meaning)["which"];
  if (meaning.which->of) json["which"]["of"] = set_of(*meaning.which->of, space);
  return json;
}

std::string readable(const Json& json, std::size_t indent, std::size_t before) {
  constexpr std::size_t widest = 116;
  const auto all_in = [&](const char* gap, const std::string& line, const auto& one) {
    std::string text;
    for (const auto& item : json.items())
      text += fmt::format("{}{}{}{}", text.empty() ? "" : gap, line,
                          json.is_object() ? Json(item.key()).dump() + ": " : "", one(item));
    return fmt::format(json.is_object() ? "{{{}{}}}" : "[{}{}]", text,
                       line.empty() || text.empty() ? "" : "\n" + std::string(indent, ' '));
  };
  if (!json.is_structured()) return json.dump();
  const std::string in_a_line =
      all_in(", ", "", [](const auto& item) { return readable(item.value(), 0, std::string::npos); });
  if (before == std::string::npos || indent + before + in_a_line.size() <= widest) return in_a_line;
  return all_in(",", "\n" + std::string(indent + 1, ' '), [&](const auto& item) {
    return readable(item.value(), indent + 1, json.is_object() ? item.key().size() + 4 : 0);
  });
}

}  // namespace

std::vector<DrawnCommand> draw_commands(const Lexicon& lexicon, const DrawRequest& request,
                                        const std::function<bool(const DrawnCommand&)>& is_fit) {
  constexpr int most_draws = 500;  // in a row that mean what another one means, or are refused
  std::vector<DrawnCommand> drawn;
  std::set<std::string> meanings;
  std::vector<std::string> open = families();
  std::map<std::string, int> of_family;
  RandomStream random(fmt::format("commands/{}", request.seed));
  const auto next = [&](const std::string& family) {
    for (int i = 0; i < most_draws; ++i) {
      auto command = make_command(lexicon, family, request.parts, random);
      if (!command) return false;
      if (meanings.count(canonical(to_json(command->meaning))) > 0) continue;
      command->id = fmt::format("drawn_{}_{}_{:02}", request.seed, family, of_family[family] + 1);
      if (!is_fit(*command)) continue;
      meanings.insert(canonical(to_json(command->meaning)));
      ++of_family[family];
      drawn.push_back(std::move(*command));
      return true;
    }
    return false;
  };
  while (static_cast<int>(drawn.size()) < request.commands && !open.empty())
    for (std::size_t i = 0; i < open.size() && static_cast<int>(drawn.size()) < request.commands;) {
      if (next(open[i]))
        ++i;
      else
        open.erase(open.begin() + static_cast<std::ptrdiff_t>(i));
    }
  if (static_cast<int>(drawn.size()) < request.commands)
    throw InputError(
        fmt::format("commands: expected at most {}, all that were found, got {}", drawn.size(), request.commands));
  return drawn;
}

Json scenario_of(const DrawnCommand& command, const FeatureSpace& space) {
  Json json{
      {"id", command.id},
      {"environment", environment()},
      {"task", task},
      {"feature_space", space.id},
      {"commands", {{{"utterance", command.utterance}, {"truth", {{"target", meaning_of(command.meaning, space)}}}}}},
      {"train", {{"as_method_asks", false}, {"distractors", {1, 2}}}},
      {"tests", {{{"arm", "test"}, {"distractors", {2, 3}}, {"near_miss", true}}}},
      {"note", fmt::format("{}.", fmt::join(command.why, "; "))}};
  if (!command.undecided.empty()) json["undecided"] = sets_of(command.undecided, space);
  if (!command.near_misses.empty()) json["near_miss_sets"] = sets_of(command.near_misses, space);
  return json;
}

bool can_be_shown(const Json& json) {
  constexpr int scenes = 20;
  try {
    const Scenario scenario = read_scenario(json, json.at("id"));
    for (int i = 0; i < scenes; ++i) {
      test_scene(scenario, layout, "test", 0, i);
      training_scene(scenario, layout, {}, 0, i);
    }
    return true;
  } catch (const NothingToShow&) {
    return false;
  }
}

Json suite_of(const std::string& id, const DrawRequest& request, const std::vector<DrawnCommand>& commands) {
  Json suite = Json::parse(R"({
    "about": {
      "title": "Drawn commands",
      "question": "What does an abstraction understand of commands that nobody has seen?",
      "main_arm": "test", "main_demonstrations": 5,
      "arms": {"test": "the target among others, one of which a careless reader of the command would take"}},
    "scenarios": [], "groups": {}, "layouts": [], "engines": ["mujoco"],
    "methods": ["lga+meaning=named", "human", "gcbc_seg"], "references": ["most_shared", "never_demonstrated"],
    "demonstrations": [5], "seeds": [0, 1, 2], "episodes": 30, "scene_seed": 0,
    "options": {"*": {"policy": "heat_map"}},
    "presets": {"smoke": {"methods": ["lga+meaning=named", "human"], "seeds": [0], "episodes": 10, "smoke": true}}})");
  suite["id"] = id;
  suite["environment"] = environment();
  suite["note"] = fmt::format("Commands drawn from a grammar and a lexicon (seed {}, {} parts of a compound one).",
                              request.seed, request.parts);
  suite["layouts"].push_back(layout);
  for (const DrawnCommand& command : commands) {
    suite["scenarios"].push_back(command.id);
    suite["groups"][command.family].push_back(command.id);
  }
  Json& few = suite["presets"]["smoke"]["scenarios"] = Json::array();
  for (std::size_t i = 0; i < std::min<std::size_t>(commands.size(), 4); ++i) few.push_back(commands[i].id);
  return suite;
}

Json scenario_of(const std::string& id, const std::vector<Person>& persons, const FeatureSpace& space) {
  Json json{{"id", id},
            {"environment", environment()},
            {"task", task},
            {"feature_space", space.id},
            {"commands", Json::array()},
            {"persons", true},
            {"questions", {{"scenes", 4}, {"errs", .05}}},
            {"train", {{"as_method_asks", false}}},
            {"tests", {{{"arm", "test"}}}}};
  for (const auto& [utterance, rule] : persons)
    json["commands"].push_back(
        {{"utterance", utterance}, {"truth", {{"target", meaning_of(meaning_of(rule, space), space)}}}});
  return json;
}

Json suite_of_persons(const std::string& id, const std::vector<std::string>& scenarios, bool hinted) {
  Json suite = Json::parse(R"({
    "note": "Persons with rules that they do not say, drawn from a grammar. What their words hold stands in every scene; what they took, and what they say when asked, tells the rule.",
    "about": {
      "title": "What a person did not say",
      "question": "What does a person want who does not say it all?",
      "main_arm": "test", "main_demonstrations": 3,
      "arms": {"test": "five objects that the words hold, each of them what another rule means"}},
    "layouts": ["continuous"], "engines": ["kinematic"],
    "methods": [
      "person_rule+learns=words", "person_rule+learns=common_looks", "person_rule+learns=common_looks+choice=scene",
      "person_rule", "person_rule+questions=1", "person_rule+questions=2", "person_rule+questions=4",
      "person_rule+choice=scene", "person_rule+choice=scene+questions=1", "person_rule+choice=scene+questions=2",
      "person_rule+choice=scene+questions=4", "person_rule+asks=random+questions=1",
      "person_rule+asks=random+questions=2", "person_rule+asks=random+questions=4", "plga+unlisted=1",
      "plga_active+unlisted=1+questions=1",
      "plga_active+unlisted=1+questions=2", "plga_active+unlisted=1+questions=4"],
    "demonstrations": [0, 1, 2, 3], "seeds": [0], "episodes": 250, "scene_seed": 0,
    "options": {"*": {"policy": "point"}},
    "presets": {
      "abstraction": {},
      "policy": {"methods": ["person_rule", "person_rule+questions=1", "person_rule+questions=2", "person_rule+questions=4"],
                 "demonstrations": [1, 2, 3], "engines": ["mujoco"], "options": {"*": {"policy": "centroid"}}},
      "smoke": {"methods": ["person_rule+learns=words", "person_rule", "person_rule+questions=1"], "demonstrations": [0, 3],
                "episodes": 50, "smoke": true}}})");
  suite["id"] = id;
  suite["environment"] = environment();
  suite["scenarios"] = scenarios;
  suite["presets"]["smoke"]["scenarios"] = {scenarios.front()};
  if (hinted)
    suite["methods"] = {"person_rule", "person_rule+learns=bayes_hint", "person_rule+choice=scene",
                        "person_rule+choice=scene+learns=bayes_hint"};
  return suite;
}

Json with_other_persons(const Json& scenario, const FeatureSpace& space, std::uint64_t seed, int first) {
  if (!scenario.value("persons", false)) return scenario;
  const PersonGrammar& grammar = person_grammar(space);
  const bool hinted = hint_in(grammar, scenario.at("commands").at(0).at("utterance")) != nullptr;
  const auto count = static_cast<int>(scenario.at("commands").size());
  Json other = scenario;
  other["commands"] =
      scenario_of(scenario.at("id"), draw_persons(grammar, seed, first, count, hinted), space).at("commands");
  return other;
}

std::string readable(const Json& json) { return readable(json, 0, 0) + "\n"; }

}  // namespace lgabench::drawn
