// lgabench demos: the oracle's demonstrations as a robomimic HDF5 file, and a look into one.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/demonstrations.hpp>
#include <lgabench/cell/hdf5.hpp>
#include <lgabench/cell/steps.hpp>
#include <lgabench/cli/commands.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/counted_progress.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/host/python_method.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench::cli {
namespace {

struct DemosArguments {
  std::string scenario, layout, engine, out, inspect, selection, python = usual_python();
  int n = 10, noisy = 0;
  double noise = .2;
  std::uint64_t seed = 0;
  std::vector<fs::path> plugin_path;
};

// The Selections of a cell's selection.json, one for each of the scenario's commands. The method is not asked again: it
// might answer otherwise.
std::vector<Selection> selections_of(const std::string& file, const Scenario& scenario) {
  const Json json = read_json(file);
  const JsonReader list = JsonReader(json, file).at("commands");
  const std::vector<JsonReader> commands = list.elements();
  if (commands.size() != scenario.commands.size())
    list.fail(fmt::format("one for each of the {} commands of {}", scenario.commands.size(), scenario.id));
  std::vector<Selection> all;
  for (const JsonReader& command : commands) {
    command.at("selection").at("target");
    const Json distribution = distribution_of(command.at("selection").json());
    all.push_back(read_distribution(JsonReader(distribution, file), scenario.space, scenario.second));
    if (all.back().empty())
      command.at("selection").fail("something selected: there is nothing to demonstrate for this command");
  }
  return all;
}

void write(const DemosArguments& a) {
  if (a.scenario.empty() || a.out.empty())
    throw InputError("demos: expected SCENARIO and --out FILE.hdf5, or --inspect FILE");
  const Scenario scenario = load_scenario(a.scenario);
  const Catalogue catalogue = plugins_at(a.plugin_path, usual_python());
  const EnvironmentType& type = *scenario.environment;
  const std::string engine = a.engine.empty() ? default_engine(catalogue, type) : a.engine;
  const auto environment = make_environment(scenario, load_engine(catalogue.engine(engine, type)));
  const std::string layout = layout_of(scenario, a.layout);
  std::vector<Scene> scenes;
  const std::vector<Selection> selections =
      a.selection.empty() ? std::vector<Selection>() : selections_of(a.selection, scenario);
  for (int i = 0; i < a.n; ++i) scenes.push_back(training_scene(scenario, layout, selections, a.seed, i));
  const Needs needs{Needs::Targets::truth, a.noisy, a.noise};
  Circumstances circumstances{scenario.id, engine, layout, "train", a.seed, environment->action_space(), {}};
  Selected selected;
  for (std::size_t c = 0; c < scenario.commands.size(); ++c)
    selected.instructions.push_back(
        {scenario.commands[c].utterance, selections.empty() ? scenario.commands[c].truth : selections[c]});
  std::vector<Demonstration> shown;
  CountedProgress progress("demonstrations made:", a.n);
  for (const Scene& scene : scenes) {
    Outcomes outcomes;
    auto one = demonstrate(*environment, {scene}, needs, scenario.utterances(), &outcomes);
    std::move(one.begin(), one.end(), std::back_inserter(shown));
    std::move(outcomes.begin(), outcomes.end(), std::back_inserter(circumstances.outcomes));
    progress.tell_next();
  }
  progress.end();
  const auto demonstrations = instructed(std::move(shown), scenes, selected);
  write_file(a.out, demonstrations_hdf5(demonstrations, "lgabench/" + scenario.id + "-v1", &circumstances));
  to_stdout("{}\n", a.out);
}

// A line a demonstration: its steps, the objects of its first picture, and its first action.
void inspect(const std::string& file) {
  const auto demonstrations = read_demonstrations(read_file(file), file);
  for (std::size_t i = 0; i < demonstrations.size(); ++i) {
    const auto& [instruction, steps, recovery] = demonstrations[i];
    std::vector<std::string> objects;
    for (const Instance& instance : steps.front().observation.instances)
      objects.push_back(instance.texture + " " + instance.object_type);
    const std::size_t count = steps.size() + recovery.size();
    to_stdout("demo_{}: {} step{}; \"{}\"; {}; action {:.3f}\n", i, count, count == 1 ? "" : "s", instruction.utterance,
              fmt::join(objects, ", "), fmt::join(steps.front().label, " "));
  }
}

}  // namespace

void add_demos(CLI::App& app, int&) {
  auto a = std::make_shared<DemosArguments>();
  Verb verb(app, "demos", worker_summary("demos"));
  verb.option("scenario SCENARIO", a->scenario, "A scenario's id; scenes are drawn from its true distribution");
  verb.below("What is demonstrated");
  verb.option("--selection FILE", a->selection,
              "Draw targets from a method's Selection instead, the selection.json of a cell");
  verb.option("--layout LAYOUT", a->layout,
              "How objects are placed: one of `lgabench list layouts --of SCENARIO` (default: the first)");
  verb.option("--n N", a->n, "Number of demonstrations", CLI::Range(1, 1'000'000), with_default);
  verb.option("--seed N", a->seed, "Training seed", a_seed(), with_default);
  verb.option("--noisy N", a->noisy, "DART: number of noisy rollouts per demonstration", CLI::Range(0, 1000),
              with_default);
  verb.option("--noise SIGMA", a->noise,
              "DART: standard deviation of the noise in the last rollout; the noise grows linearly up to it",
              within(0, 10), with_default);
  verb.option("--engine ENGINE", a->engine, "An engine, by plugin id (default: the one that suites use)");
  add_plugin_path(verb, a->plugin_path, any_plugin);
  add_python(verb, a->python);
  add_scenario_path(verb);
  verb.below("Files");
  auto* out = verb.option("--out FILE", a->out, "The HDF5 file to write");
  verb.option("--inspect FILE", a->inspect, "Print the contents of a file of demonstrations")->excludes(out);
  verb->footer(
      "Example: lgabench demos heart --n 10 --out heart.hdf5\nThe demonstrations that a method of a run got: lgabench "
      "demos heart --selection runs/NAME/cells/KEY/selection.json --out lga.hdf5");
  verb->callback([a] { a->inspect.empty() ? write(*a) : inspect(a->inspect); });
}

}  // namespace lgabench::cli
