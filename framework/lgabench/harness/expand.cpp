#include <lgabench/harness/expand.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include <lgabench/abstraction/selection_errors.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/harness/competitors.hpp>
#include <lgabench/harness/suite_scenario.hpp>
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
void expect_dynamics(const Scenario& scenario, const std::optional<PluginInfo>& engine) {
  if (!engine || !engine->kinematic) return;
  for (const std::string& id : played_arms(scenario.json))
    for (const PerturbationAxis* axis : scenario.arm(id).axes) {
      const BodyVariants bodies = axis->bodies ? axis->bodies(scenario.arm(id).perturbation->level) : BodyVariants();
      if (bodies.friction != 1 || bodies.mass != 1)
        throw InputError(
            fmt::format("scenario {}, arm {}: {} on the engine {}, whose bodies have neither friction nor "
                        "mass: expected another engine, or other perturbations",
                        scenario.id, id, axis->id, engine->id));
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

// What a policy is trained on; policy=point is not trained, nor is a method without the framework's epochs.
void expect_demonstrations(const Design& design, const std::vector<Competitor>& methods, const Catalogue& catalogue) {
  if (!contains(design.demonstrations, 0)) return;
  for (const Competitor& method : methods) {
    const Json& options = catalogue.find("method", method.acts ? method.acts->id : method.id).options;
    const auto is_frameworks = [&options](const char* name) {
      return options.contains(name) && options[name].value("framework", false);
    };
    if (!is_frameworks("epochs")) continue;
    const bool has_policies = is_frameworks("policy");
    const Json policy = (method.acts ? method.acts->options : method.options)
                            .value("policy", has_policies ? options["policy"]["default"] : Json());
    if (policy == "point") continue;
    const bool may_point = has_policies && contains(options["policy"].value("values", Json::array()), Json("point"));
    throw InputError(fmt::format(
        "demonstrations: expected 1 or more for {}, whose policy{} is trained on them, got 0{}", method.name,
        has_policies ? " (" + policy.get<std::string>() + ")" : "", may_point ? "; policy=point needs none" : ""));
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

// A row of a run's table: a method with the errors that are made in what it selects, what its names are read by, and
// the person who answers for it; or a reference row.
struct Row {
  Competitor method;  // named as the row is
  SelectionErrors errors = {};
  Reading reading = {};
  std::optional<CellParticipant> participant = {};
};

std::vector<Row> method_rows(const Suite& suite, const std::vector<Competitor>& methods,
                             const std::vector<SelectionErrors>& all_errors, const std::vector<Reading>& readings) {
  std::vector<Row> rows;
  for (const Competitor& method : methods)
    for (const SelectionErrors& errors : all_errors) {
      if (!errors.none() && contains(suite.selects_nothing, method.id)) continue;
      for (const Reading& reading : readings) {
        rows.push_back({method, errors, reading});
        rows.back().method.name += errors.suffix() + reading.suffix();
      }
    }
  return rows;
}

std::vector<Row> rows_of_references(const Suite& suite) {
  std::vector<Row> rows;
  for (const ReferenceRow& row : reference_rows())
    if (row.in_every_suite || contains(suite.references, row.id))
      rows.push_back({{"reference", row.id, row.id, "1", Json::object()}});
  return rows;
}

// The rows that the scenario has: one for each person, where people answer.
std::vector<Row> rows_in(const Scenario& scenario, const std::vector<Row>& rows,
                         const std::vector<Participant>& people) {
  std::vector<Row> all;
  for (const Row& row : rows)
    for (const auto& participant : participants(row.method, scenario, people)) {
      all.push_back(row);
      all.back().participant = participant;
    }
  return all;
}

// Where rows play: a scenario in one layout on one engine.
struct Place {
  const Scenario& scenario;
  Cell cell;  // of no row yet
};

Cell cell_of(const Place& place, const Row& row, int demonstrations, std::uint64_t training_seed) {
  Cell cell = place.cell;
  cell.method = row.method;
  cell.selection_errors = row.errors;
  cell.reading = row.reading;
  if (!row.reading.none()) cell.data = data_hashes(place.scenario, cell.answers, row.reading);
  if (row.method.is_reference()) cell.train_on.reset();
  cell.participant = row.participant;
  cell.demonstrations = demonstrations;
  cell.training_seed = training_seed;
  return cell;
}

std::vector<Cell> cells_at(const Place& place, const std::vector<Row>& methods, const std::vector<Row>& references,
                           const Design& design) {
  std::vector<Cell> cells;
  for (const int n : design.demonstrations)
    for (const std::uint64_t seed : design.seeds) {
      for (const Row& row : methods) cells.push_back(cell_of(place, row, n, seed));
      for (const Row& row : references)
        if (learns(row.method) && n > 0) cells.push_back(cell_of(place, row, n, seed));
    }
  for (const Row& row : references) {
    if (learns(row.method)) continue;
    for (const std::uint64_t seed : scene_sets(design.test_scenes, design.seeds))
      cells.push_back(cell_of(place, row, 0, seed));
  }
  return cells;
}

// The suite's scenario with the arms that are asked for, and their control.
Scenario played_scenario(const Suite& suite, const std::string& id, const Design& design, const Variation& variation) {
  Scenario scenario = suite_scenario(suite, id, variation.truth, &design);
  if (!variation.played) return scenario;
  const std::string control = scenario.tests.front().id;
  for (const Arm& arm : scenario.tests)
    if (arm.id == control || plays(*variation.played, arm)) scenario.json["played"].push_back(arm.id);
  return scenario;
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
  const EnvironmentType& environment = find_environment(suite.environment);
  for (const std::string& engine : design.engines) catalogue.engine(engine, environment);
  expect_demonstrations(design, methods, catalogue);
  if (variation.played) expect_arms(*variation.played, arms_of(suite, design), suite);
  if (!variation.participants.empty() && std::none_of(methods.begin(), methods.end(), asks_people))
    throw InputError("--humans: expected a method that asks people, such as human or lga_hill; this run has none");

  std::vector<SelectionErrors> all_errors = design.selection_errors;
  if (all_errors.empty()) all_errors.emplace_back();
  const std::vector<Reading> readings = readings_of(suite, design, catalogue);
  const std::vector<Row> rows = method_rows(suite, methods, all_errors, readings);
  const std::vector<Row> references = variation.references ? rows_of_references(suite) : std::vector<Row>();
  std::vector<Cell> cells;
  for (const std::string& id : suite_scenario_ids(suite, design)) {
    const Scenario scenario = played_scenario(suite, id, design, variation);
    expect_own_scenes(suite, design, scenario);
    expect_layouts(scenario, design.layouts);
    expect_errors_possible(suite, scenario, all_errors);
    expect_read(suite, scenario, readings);
    for (const std::string& engine : design.engines) expect_dynamics(scenario, catalogue.engine(engine, environment));
    const std::vector<Row> answered = rows_in(scenario, rows, variation.participants);
    Place place{scenario, unplayed_cell(suite, design, scenario, variation.answers)};
    place.cell.train_on = design.train_on;
    for (const std::string& layout : design.layouts)
      for (const std::string& engine : design.engines) {
        place.cell.layout = layout;
        place.cell.engine = engine;
        std::vector<Cell> there = cells_at(place, answered, references, design);
        std::move(there.begin(), there.end(), std::back_inserter(cells));
      }
  }
  expect_each_method(methods, cells);
  return cells;
}

}  // namespace lgabench
