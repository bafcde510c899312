#include <lgabench/harness/expand.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include <lgabench/abstraction/selection_errors.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/harness/competitors.hpp>
#include <lgabench/record/reference_rows.hpp>

namespace lgabench {
namespace {

bool asks_people(const Competitor& method) { return method.asks == "specify" || method.asks == "edit"; }

// Those whose answers the method is based on in this scenario; a single nullopt where the method asks no one, or where
// the truth stands in for people.
using Answering = std::vector<std::optional<CellParticipant>>;
Answering participants(const Competitor& method, const Scenario& scenario, const std::vector<Participant>& all) {
  if (all.empty() || !asks_people(method)) return {std::nullopt};
  const auto how = method.asks == "specify" ? &Participant::Answer::specified : &Participant::Answer::edited;
  Answering some;
  for (const Participant& one : all)
    if (one.answered_all(scenario, how)) some.push_back(CellParticipant{one.id, one.sha256, one.rehearsal});
  return some;
}

// A method that people answer for shall not vanish from the table because they were asked about other scenarios.
void expect_each_method(const std::vector<Competitor>& methods, const std::vector<Cell>& cells) {
  for (const Competitor& method : methods)
    if (std::none_of(cells.begin(), cells.end(), [&](const Cell& c) {
          return c.method.name == method.name + c.selection_errors.suffix() + c.reading.suffix();
        }))
      throw InputError(fmt::format("--humans: no person answered for {} in a scenario of this run", method.name));
}

// Which members of a meaning are seen is each training seed's own.
void expect_own_scenes(const Suite& suite, const Design& design, const Scenario& scenario) {
  const Json& arms = scenario.json.at("tests");
  if (design.test_scenes != TestScenes::per_seed &&
      std::any_of(arms.begin(), arms.end(), [](const Json& arm) { return arm.contains("members"); }))
    throw InputError(
        fmt::format("{}: /test_scenes: expected per_seed, since \"members\" gives each training seed "
                    "scenes of its own",
                    suite.file));
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

// Errors can only be made in what is one product.
void expect_errors_possible(const Suite& suite, const Scenario& scenario, const std::vector<SelectionErrors>& errors) {
  const bool any = std::any_of(errors.begin(), errors.end(), [](const SelectionErrors& e) { return !e.none(); });
  if (const std::string why = any ? why_no_selection_errors(scenario) : ""; !why.empty())
    throw InputError(fmt::format("{}: /selection_errors: scenario {}: {}", suite.file, scenario.id, why));
}

// Every pair of where names and where segments come from; the simulator's where the design says nothing.
std::vector<Reading> readings_of(const Suite& suite, const Design& design, const Catalogue& catalogue) {
  const std::vector<std::string> simulator{Reading::simulator};
  std::vector<std::string> known{Reading::simulator};
  known.insert(known.end(), names_read().begin(), names_read().end());
  for (const PluginInfo& plugin : catalogue.plugins)
    if (plugin.kind == "perceiver") known.push_back(plugin.id);
  std::vector<Reading> all;
  for (const std::string& names : design.names.empty() ? simulator : design.names)
    for (const std::string& segments : design.segments.empty() ? simulator : design.segments) {
      if (!contains(known, names))
        throw InputError(fmt::format("{}: /names: {}", suite.file, none_named("names or perceiver", names, known)));
      all.push_back({names, segments});
    }
  return all;
}

void expect_read(const Suite& suite, const Scenario& scenario, const std::vector<Reading>& readings) {
  for (const Reading& reading : readings)
    if (const std::string why = why_not_read(scenario, reading); !why.empty())
      throw InputError(fmt::format("{}: /names{}: scenario {}: {}", suite.file, reading.suffix(), scenario.id, why));
}

// A perturbation of what the engine does not simulate would be none.
void expect_dynamics(const Scenario& scenario, const PluginInfo& engine) {
  if (!engine.kinematic) return;
  for (const std::string& id : played_arms(scenario.json))
    for (const PerturbationAxis* axis : scenario.arm(id).axes) {
      const BodyVariants bodies = axis->bodies ? axis->bodies(scenario.arm(id).perturbation->level) : BodyVariants();
      if (bodies.friction != 1 || bodies.mass != 1)
        throw InputError(
            fmt::format("scenario {}, arm {}: {} on the engine {}, whose bodies have neither friction nor "
                        "mass: expected another engine, or other perturbations",
                        scenario.id, id, axis->id, engine.id));
    }
}

bool plays(const PlayedArms& played, const Arm& arm) {
  const std::optional<Perturbation>& one = arm.perturbation;
  return contains(played.arms, arm.id) ||
         std::any_of(played.axes.begin(), played.axes.end(), [&](const DesignAxis& axis) {
           return one && axis.axis == one->axis &&
                  (axis.levels.empty() || std::count(axis.levels.begin(), axis.levels.end(), one->level) > 0);
         });
}

// What is asked for must be in one of the scenarios.
void expect_arms(const PlayedArms& played, const SuiteArms& there, const Suite& suite) {
  for (const std::string& arm : played.arms)
    if (!contains(there.ids, arm)) throw InputError("--arms: " + none_named("arm", arm, there.ids));
  std::vector<std::string> axes;
  for (const auto& axis : there.axes) axes.push_back(axis.first);
  for (const DesignAxis& axis : played.axes) {
    if (axes.empty()) throw InputError(fmt::format("--axes: {} has no perturbations here", suite.id));
    if (!contains(axes, axis.axis)) throw InputError("--axes: " + none_named("axis", axis.axis, axes));
    const std::set<int>& levels = there.axes.at(axis.axis);
    for (const int level : axis.levels)
      if (levels.count(level) == 0)
        throw InputError(fmt::format("--axes: {} has no level {} here, expected one of: {}", axis.axis, level,
                                     fmt::join(levels, ", ")));
  }
}

// What a policy is trained on; policy=point is not trained.
void expect_demonstrations(const Design& design, const std::vector<Competitor>& methods, const Catalogue& catalogue) {
  if (!contains(design.demonstrations, 0)) return;
  for (const Competitor& method : methods) {
    const Json& options = catalogue.find("method", method.acts ? method.acts->id : method.id).options;
    if (!options.contains("policy") || !options["policy"].value("framework", false)) continue;
    const Json policy =
        (method.acts ? method.acts->options : method.options).value("policy", options["policy"]["default"]);
    if (policy != "point")
      throw InputError(
          fmt::format("demonstrations: expected 1 or more for {}, whose policy ({}) is trained on them, "
                      "got 0; policy=point needs none",
                      method.name, policy.get<std::string>()));
  }
}

// A suite's scenarios may be of several tasks, each with layouts of its own.
void expect_layouts(const Scenario& scenario, const std::vector<std::string>& layouts) {
  const std::vector<std::string> there = layouts_of(scenario);
  for (const std::string& layout : layouts)
    if (!contains(there, layout))
      throw InputError(fmt::format("scenario {} ({}): {}", scenario.id, scenario.environment->id(),
                                   none_named("layout", layout, there)));
}

}  // namespace

Cell unplayed_cell(const Suite& suite, const Design& design, const Scenario& scenario, const AnswerSource& answers) {
  Cell cell;
  cell.suite = suite.id;
  cell.environment = suite.environment;
  cell.scenario = std::make_shared<const Json>(scenario.json);
  cell.scene_seed = design.scene_seed;
  cell.test_scenes = design.test_scenes;
  cell.episodes = design.episodes;
  cell.answers = answers;
  cell.data = data_hashes(scenario, cell.answers, cell.reading);
  cell.smoke = design.smoke;
  return cell;
}

std::vector<std::string> suite_scenario_ids(const Suite& suite, const Design& design) {
  if (suite.variants.empty()) return design.scenarios;
  std::vector<std::string> ids;
  for (const std::string& id : design.scenarios)
    for (const auto& variant : suite.variants) ids.push_back(fmt::format("{}_{}", id, variant.first));
  return ids;
}

Scenario suite_scenario(const Suite& suite, const std::string& id, Truth truth, const Design* of) {
  const Design& design = of ? *of : suite.design;
  std::string base = id, variant;
  for (const auto& named : suite.variants) {
    const std::string end = "_" + named.first;
    if (id.size() <= end.size() || id.compare(id.size() - end.size(), end.size(), end) != 0) continue;
    base = id.substr(0, id.size() - end.size());
    variant = named.first;
  }
  const Scenario scenario = load_scenario(base, truth);
  if (scenario.environment->id() != suite.environment)
    throw InputError(fmt::format("{}: /scenarios: \"{}\" is a scenario of {}, expected {}", suite.file, id,
                                 scenario.environment->id(), suite.environment));
  Json json = scenario.json;
  if (!suite.train.empty()) json["train"].update(suite.train);
  const Json scenes = suite.scenes.count(base) ? suite.scenes.at(base) : Json::object();
  if (!scenes.empty()) json["train"].update(scenes);
  if (suite.paraphrases.count(base)) add_wordings(suite, base, json);
  if (suite.answers.count(base)) json["answers"] = {{"recorded", suite.answers.at(base)}};
  const SuiteVariant changes = variant.empty() ? SuiteVariant() : suite.variants.at(variant);
  if (!changes.train.empty()) json["train"].update(changes.train);
  if (changes.commands) json["commands"] = first_commands(json["commands"], *changes.commands);
  const Json first = json["tests"].front();
  if (suite.only_arms) json["tests"] = Json::array();
  for (const SuiteArm& arm : changes.arms.value_or(suite.arms)) {
    if (contains(arm.except, base) || contains(arm.except, id) ||
        (!design.arms.empty() && !contains(design.arms, arm.id)))
      continue;
    json["tests"].push_back(first);
    json["tests"].back().update(arm.members);
    json["tests"].back().update(scenes);
    if (suite.near_miss.count(base) && arm.members.value("near_miss", Json()) == Json(true))
      json["tests"].back()["near_miss"] = suite.near_miss.at(base);
  }
  const Json control = json["tests"].front();
  for (const DesignAxis& axis : design.perturbations) {
    if (axis.except && contains(*axis.except, base)) continue;
    for (const int level : axis.levels) {
      const Perturbation one{axis.axis, level};
      json["tests"].push_back(control);
      json["tests"].back().update({{"arm", arm_of(one)}, {"perturbation", {{one.axis, one.level}}}});
    }
  }
  if (!variant.empty()) {
    json["id"] = id;
    json["answers_of"] = scenario.answers_of;
    for (Json& arm : json["tests"]) arm["arm"] = arm["arm"].get<std::string>() + "_" + variant;
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

Json to_json(const PlayedArms& played) {
  Json json{{"arms", played.arms}, {"axes", Json::array()}};
  for (const DesignAxis& axis : played.axes) json["axes"].push_back({{"axis", axis.axis}, {"levels", axis.levels}});
  return json;
}

bool learns(const Competitor& row) {
  if (!row.is_reference()) return true;
  const ReferenceRow* const reference = find_reference_row(row.id);
  return reference && reference->learns;
}

std::vector<Cell> expand(const Suite& suite, const Design& design, const Variation& variation,
                         const Catalogue& catalogue) {
  const std::vector<Competitor> methods = competitors(suite, design, variation.options, catalogue);
  for (const std::string& engine : design.engines) catalogue.find("engine", engine);
  expect_demonstrations(design, methods, catalogue);
  if (variation.played) expect_arms(*variation.played, arms_of(suite, design), suite);
  if (!variation.participants.empty() && std::none_of(methods.begin(), methods.end(), asks_people))
    throw InputError("--humans: expected a method that asks people, such as human or lga_hill; this run has none");

  std::vector<Competitor> references;
  if (variation.references)
    for (const ReferenceRow& row : reference_rows())
      if (row.in_every_suite || contains(suite.references, row.id))
        references.push_back({"reference", row.id, row.id, "1", Json::object()});
  std::vector<SelectionErrors> all_errors = design.selection_errors;
  if (all_errors.empty()) all_errors.emplace_back();
  const std::vector<Reading> readings = readings_of(suite, design, catalogue);
  std::vector<Cell> cells;
  for (const std::string& id : suite_scenario_ids(suite, design)) {
    Scenario scenario = suite_scenario(suite, id, variation.truth, &design);
    if (variation.played) {
      const std::string control = scenario.tests.front().id;
      for (const Arm& arm : scenario.tests)
        if (arm.id == control || plays(*variation.played, arm)) scenario.json["played"].push_back(arm.id);
    }
    expect_own_scenes(suite, design, scenario);
    expect_layouts(scenario, design.layouts);
    expect_errors_possible(suite, scenario, all_errors);
    expect_read(suite, scenario, readings);
    for (const std::string& engine : design.engines) expect_dynamics(scenario, catalogue.find("engine", engine));
    Cell cell = unplayed_cell(suite, design, scenario, variation.answers);
    const auto as_simulated = cell.data;
    const auto add = [&](const Competitor& method, int demonstrations, std::uint64_t seed,
                         const SelectionErrors& errors = {}, const Reading& reading = {}) {
      cell.method = method;
      cell.method.name += errors.suffix() + reading.suffix();
      cell.selection_errors = errors;
      cell.reading = reading;
      cell.data = reading.none() ? as_simulated : data_hashes(scenario, cell.answers, reading);
      cell.train_on = method.is_reference() ? std::nullopt : design.train_on;
      cell.demonstrations = demonstrations;
      cell.training_seed = seed;
      for (const auto& participant : participants(method, scenario, variation.participants)) {
        cell.participant = participant;
        cells.push_back(cell);
      }
    };
    for (const std::string& layout : design.layouts) {
      for (const std::string& engine : design.engines) {
        cell.layout = layout;
        cell.engine = engine;
        for (const int n : design.demonstrations)
          for (const std::uint64_t seed : design.seeds) {
            for (const Competitor& method : methods)
              for (const SelectionErrors& errors : all_errors)
                if (errors.none() || !contains(suite.selects_nothing, method.id))
                  for (const Reading& reading : readings) add(method, n, seed, errors, reading);
            for (const Competitor& row : references)
              if (learns(row) && n > 0) add(row, n, seed);
          }
        for (const Competitor& row : references)
          if (!learns(row))
            for (const std::uint64_t seed : scene_sets(design.test_scenes, design.seeds)) add(row, 0, seed);
      }
    }
  }
  expect_each_method(methods, cells);
  return cells;
}

}  // namespace lgabench
