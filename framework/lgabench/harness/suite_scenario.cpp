#include <lgabench/harness/suite_scenario.hpp>

#include <fmt/format.h>

#include <utility>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/perturbations.hpp>

namespace lgabench {
namespace {

// One of a suite's scenarios.
struct NamedScenario {
  std::string id;            // in the suite
  std::string base;          // of the scenario that it is made from
  std::string variant = {};  // "": none
};

NamedScenario named(const Suite& suite, const std::string& id) {
  NamedScenario found{id, id};
  for (const auto& variant : suite.variants) {
    const std::string end = "_" + variant.first;
    if (id.size() <= end.size() || id.compare(id.size() - end.size(), end.size(), end) != 0) continue;
    found.base = id.substr(0, id.size() - end.size());
    found.variant = variant.first;
  }
  return found;
}

// The first `count` of those that are demonstrated, and all others.
Json first_commands(const Json& commands, std::size_t count) {
  Json some = Json::array();
  for (const Json& command : commands) {
    const bool demonstrated = command.value("seen", true);
    if (!demonstrated || count > 0) some.push_back(command);
    if (demonstrated && count > 0) --count;
  }
  return some;
}

// To the scenario's command other ways to say it, with the answers to all of them: of one model.
void add_wordings(const Suite& suite, const std::string& id, Json& json) {
  const std::string other = suite.paraphrases.at(id);
  const Scenario from = load_scenario(other);
  if (from.commands.front().utterance != json["commands"].front().at("utterance"))
    throw InputError(fmt::format("{}: /paraphrases/{}: expected a scenario whose first command is {}, got {} of {}",
                                 suite.file, id, canonical(json["commands"].front().at("utterance")),
                                 canonical(Json(from.commands.front().utterance)), other));
  int wording = 0;
  for (Json command : from.json.at("commands")) {
    if (command.value("seen", true)) continue;
    command.erase("arm");
    command["wording"] = ++wording;
    json["commands"].push_back(std::move(command));
  }
  json["answers"] = from.json.value("answers", Json{{"recorded", from.recorded}});
  json["answers_of"] = from.answers_of;
}

Json scenes_of(const Suite& suite, const std::string& base) {
  const auto found = suite.scenes.find(base);
  return found == suite.scenes.end() ? Json::object() : found->second;
}

void update_train(Json& json, const Json& members) {
  if (!members.empty()) json["train"].update(members);
}

// Behind the scenario's arms, or in their place, those of the suite that the design plays in this scenario: each is the
// first one but for its members.
void add_arms(const Suite& suite, const std::vector<SuiteArm>& arms, const Design& design,
              const NamedScenario& scenario, Json& tests) {
  const Json first = tests.front(), scenes = scenes_of(suite, scenario.base);
  const auto near_miss = suite.near_miss.find(scenario.base);
  if (suite.only_arms) tests = Json::array();
  for (const SuiteArm& arm : arms) {
    if (contains(arm.except, scenario.base) || contains(arm.except, scenario.id)) continue;
    if (!design.arms.empty() && !contains(design.arms, arm.id)) continue;
    Json added = first;
    added.update(arm.members);
    added.update(scenes);
    const Json near = arm.members.value("near_miss", Json());
    const bool sized = near.is_object() && near.contains("size");  // which says nothing of what they are
    if (near_miss != suite.near_miss.end() && (near == Json(true) || sized)) {
      added["near_miss"] = near_miss->second;
      if (sized) added["near_miss"]["size"] = near.at("size");
    }
    tests.push_back(std::move(added));
  }
}

// The control once more for each axis and level of the design.
void add_perturbations(const Design& design, const std::string& base, Json& tests) {
  const Json control = tests.front();
  for (const DesignAxis& axis : design.perturbations) {
    if (axis.except && contains(*axis.except, base)) continue;
    for (const int level : axis.levels) {
      const Perturbation one{axis.axis, level};
      tests.push_back(control);
      tests.back().update({{"arm", arm_of(one)}, {"perturbation", {{one.axis, one.level}}}});
    }
  }
}

}  // namespace

std::vector<std::string> suite_scenario_ids(const Suite& suite, const Design& design) {
  if (suite.variants.empty()) return design.scenarios;
  std::vector<std::string> ids;
  for (const std::string& id : design.scenarios)
    for (const auto& variant : suite.variants) ids.push_back(fmt::format("{}_{}", id, variant.first));
  return ids;
}

Scenario suite_scenario(const Suite& suite, const std::string& id, Truth truth, const Design* of) {
  const Design& design = of ? *of : suite.design;
  const NamedScenario one = named(suite, id);
  const Scenario scenario = load_scenario(one.base, truth);
  if (scenario.environment->id() != suite.environment)
    throw InputError(fmt::format("{}: /scenarios: \"{}\" is a scenario of {}, expected {}", suite.file, id,
                                 scenario.environment->id(), suite.environment));
  const SuiteVariant changes = one.variant.empty() ? SuiteVariant() : suite.variants.at(one.variant);
  Json json = scenario.json;
  update_train(json, suite.train);
  update_train(json, scenes_of(suite, one.base));
  if (suite.paraphrases.count(one.base)) add_wordings(suite, one.base, json);
  if (suite.answers.count(one.base)) json["answers"] = {{"recorded", suite.answers.at(one.base)}};
  update_train(json, changes.train);
  if (changes.commands) json["commands"] = first_commands(json["commands"], *changes.commands);
  add_arms(suite, changes.arms.value_or(suite.arms), design, one, json["tests"]);
  add_perturbations(design, one.base, json["tests"]);
  if (!one.variant.empty()) {
    json["id"] = id;
    json["answers_of"] = scenario.answers_of;
    for (Json& arm : json["tests"]) arm["arm"] = arm["arm"].get<std::string>() + "_" + one.variant;
  }
  return read_scenario(json, fmt::format("{}: scenario {} with the suite's members", suite.file, id));
}

SuiteArms arms_of(const Suite& suite, const Design& design) {
  SuiteArms all;
  for (const std::string& id : suite_scenario_ids(suite, design))
    for (const Arm& arm : suite_scenario(suite, id, Truth::released, &design).tests) {
      if (!contains(all.ids, arm.id)) all.ids.push_back(arm.id);
      if (arm.perturbation) all.axes[arm.perturbation->axis].insert(arm.perturbation->level);
    }
  return all;
}

}  // namespace lgabench
