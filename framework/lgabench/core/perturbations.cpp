#include <lgabench/core/perturbations.hpp>

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/suggest.hpp>

namespace lgabench {
namespace {

// What bodies each arm with a perturbation may ask for: of all its axes together.
std::vector<BodyVariants> bodies_of_arms(const Scenario& scenario) {
  std::vector<BodyVariants> all;
  for (const Arm& arm : scenario.tests) {
    if (!arm.perturbation) continue;
    BodyVariants& of_arm = all.emplace_back();
    for (const PerturbationAxis* axis : arm.axes) {
      if (!axis->bodies) continue;
      const BodyVariants of_axis = axis->bodies(arm.perturbation->level);
      if (of_axis.scales.size() > 1) of_arm.scales = of_axis.scales;
      of_arm.friction *= of_axis.friction;
      of_arm.mass *= of_axis.mass;
      of_arm.more += of_axis.more;
    }
  }
  return all;
}

PluginAxes& added_axes() {
  static PluginAxes axes;
  return axes;
}

const PerturbationAxis* find_axis(const PluginAxes& axes, const std::string& id) {
  const auto found = std::find_if(axes.begin(), axes.end(), [&id](const auto& axis) { return axis->id == id; });
  return found == axes.end() ? nullptr : found->get();
}

EpisodePart perceived_part(const JsonReader& name) {
  for (const EpisodePart part : {EpisodePart::rgb, EpisodePart::ids, EpisodePart::instances})
    if (name.string() == part_names.at(static_cast<std::size_t>(part))) return part;
  name.fail("rgb, ids or instances, the parts of an observation");
}

std::vector<EpisodePart> perceived_parts(const JsonReader& list) {
  std::vector<EpisodePart> some;
  for (const JsonReader& element : list.elements()) {
    some.push_back(perceived_part(element));
    if (std::count(some.begin(), some.end(), some.back()) > 1) element.fail("each part once");
  }
  return some;
}

}  // namespace

bool PerturbationAxis::touches(EpisodePart part) const {
  if (part != EpisodePart::input) return contains(changes, part) || contains(may_change, part);
  for (const EpisodePart of_input :
       {EpisodePart::rgb, EpisodePart::ids, EpisodePart::instances, EpisodePart::words, EpisodePart::selection})
    if (touches(of_input)) return true;
  return false;
}

const std::vector<PerturbationAxis>& perturbation_axes() {
  // Never closed: functions of the axes live as long as the program. Not linked, as most programs never blur a picture.
  static const std::vector<PerturbationAxis>* const axes = [] {
    const fs::path file = library_directory() / perturbation_library;
    void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    const auto entry =
        library ? reinterpret_cast<decltype(&lgabench_perturbations)>(::dlsym(library, "lgabench_perturbations"))
                : nullptr;
    if (!entry) throw InputError(fmt::format("perturbations: {}", ::dlerror()));
    return entry();
  }();
  return *axes;
}

const PluginAxes& plugin_axes() { return added_axes(); }

void add_plugin_axis(PerturbationAxis axis) {
  const std::vector<std::string> taken = perturbation_ids();
  if (contains(taken, axis.id))
    throw InputError(fmt::format("perturbation \"{}\": an axis has that id already", axis.id));
  added_axes().push_back(std::make_shared<PerturbationAxis>(std::move(axis)));
}

std::vector<std::string> part_words(const std::vector<EpisodePart>& some) {
  std::vector<std::string> names;
  for (const EpisodePart part : some) names.emplace_back(part_names.at(static_cast<std::size_t>(part)));
  return names;
}

Json axis_json(const PerturbationAxis& axis) {
  Json json{{"version", axis.version}, {"levels", axis.levels}, {"changes", part_words(axis.changes)}};
  if (!axis.may_change.empty()) json["may_change"] = part_words(axis.may_change);
  if (axis.named) json["named"] = true;
  return json;
}

PerturbationAxis read_axis(const std::string& id, const JsonReader& reader) {
  reader.only({"version", "levels", "changes", "may_change", "named"});
  PerturbationAxis axis{id, reader.at("levels").strings(), perceived_parts(reader.at("changes"))};
  if (axis.levels.empty()) reader.at("levels").fail("a description of each level, from level 1");
  if (axis.changes.empty()) reader.at("changes").fail("at least one part");
  if (reader.has("may_change")) axis.may_change = perceived_parts(reader.at("may_change"));
  if (reader.has("named")) axis.named = reader.at("named").boolean();
  axis.of_plugin = true;
  if (reader.has("version")) axis.version = reader.at("version").string();
  axis.perceive = [id](const Observation&, const Scenario&, int, const RandomStream&) -> Observation {
    throw InputError(fmt::format("perturbation {}: its plugin runs only in the cells of a run", id));
  };
  return axis;
}

PluginAxes read_plugin_axes(const JsonReader& scenario) {
  PluginAxes all;
  if (scenario.has("axes")) {
    const JsonReader axes = scenario.at("axes");
    if (!axes.json().is_object()) axes.fail("an object");
    for (const auto& [id, ignored] : axes.json().items()) {
      axes.at(id).at("version").string();
      all.push_back(std::make_shared<PerturbationAxis>(read_axis(id, axes.at(id))));
    }
  }
  for (const auto& axis : plugin_axes())
    if (!find_axis(all, axis->id)) all.push_back(std::make_shared<PerturbationAxis>(*axis));
  return all;
}

std::vector<std::string> perturbation_ids(const PluginAxes& more) {
  std::vector<std::string> ids;
  for (const PerturbationAxis& axis : perturbation_axes()) ids.push_back(axis.id);
  for (const auto& axis : more) ids.push_back(axis->id);
  ids.emplace_back(all_axes);
  return ids;
}

std::vector<const PerturbationAxis*> axes_named(const std::string& id, const PluginAxes& more) {
  std::vector<const PerturbationAxis*> axes;
  for (const PerturbationAxis& axis : perturbation_axes())
    if (id == axis.id || (id == all_axes && axis.of_all)) axes.push_back(&axis);
  if (const PerturbationAxis* added = find_axis(more, id); axes.empty() && added) axes.push_back(added);
  if (axes.empty()) throw InputError(none_named("axis", id, perturbation_ids(more)));
  return axes;
}

bool operator==(const BodyVariant& a, const BodyVariant& b) {
  return a.scale == b.scale && a.friction == b.friction && a.mass == b.mass;
}

std::string lacks_engine(const Scenario& scenario, int /*level*/) {
  const EnvironmentType& environment = *scenario.environment;
  return environment.has_engine()
             ? ""
             : fmt::format("expected an environment with an engine plugin, {} has none", environment.id());
}

std::string lacking(const Scenario& scenario, const Perturbation& perturbation) {
  if (perturbation.axis == all_axes) return "";
  const PerturbationAxis& axis = *axes_named(perturbation.axis, scenario.axes).front();
  return axis.lacks ? axis.lacks(scenario, perturbation.level) : "";
}

std::vector<const PerturbationAxis*> axes_of(const Scenario& scenario, const Perturbation& perturbation) {
  std::vector<const PerturbationAxis*> axes = axes_named(perturbation.axis, scenario.axes);
  const auto is_lacking = [&](const PerturbationAxis* axis) {
    return axis->lacks && !axis->lacks(scenario, perturbation.level).empty();
  };
  axes.erase(std::remove_if(axes.begin(), axes.end(), is_lacking), axes.end());
  return axes;
}

std::vector<BodyVariant> body_variants(const Scenario& scenario) {
  std::vector<BodyVariant> all{{}};
  for (const BodyVariants& of_arm : bodies_of_arms(scenario))
    for (const double scale : of_arm.scales) {
      const BodyVariant one{scale, of_arm.friction, of_arm.mass};
      if (!contains(all, one)) all.push_back(one);
    }
  return all;
}

int more_bodies(const Scenario& scenario) {
  int most = 0;
  for (const BodyVariants& of_arm : bodies_of_arms(scenario)) most = std::max(most, of_arm.more);
  return most;
}

Scene perturbed(Scene scene, const Scenario& scenario, std::optional<std::uint64_t> training_seed) {
  const Arm& arm = scenario.arm(scene.arm);
  for (const PerturbationAxis* axis : arm.axes) {
    if (!axis->change) continue;
    // Its own statement: as an argument it could read the scene after the move.
    const RandomStream stream = perturbation_stream(axis->id, scene, training_seed);
    scene = axis->change(std::move(scene), scenario, arm.perturbation->level, stream);
  }
  return scene;
}

Perturbation read_perturbation(const JsonReader& reader, const PluginAxes& more) {
  const Json& json = reader.json();
  if (!json.is_object() || json.size() != 1)
    reader.fail(fmt::format("an object with one axis and its level (two at once: {}), one of: {}", all_axes,
                            fmt::join(perturbation_ids(more), ", ")));
  const std::string id = json.begin().key();
  const JsonReader level = reader.at(id);
  std::vector<const PerturbationAxis*> axes;
  try {
    axes = axes_named(id, more);
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}: {}", reader.file(), reader.place(), e.what()));
  }
  const int most = (*std::min_element(axes.begin(), axes.end(), [](const auto* a, const auto* b) {
                     return a->most() < b->most();
                   }))->most();
  if (!level.json().is_number_integer() || level.json() < 1 || level.json() > most)
    level.fail(id == all_axes ? fmt::format("a level from 1 to {}", most)
                              : fmt::format("a level from 1 to {} ({})", most, fmt::join(axes.front()->levels, "; ")));
  return {id, level.json().get<int>()};
}

void expect_shown(const JsonReader& perturbation, const std::vector<const PerturbationAxis*>& axes,
                  const std::string& environment, bool has_views) {
  for (const PerturbationAxis* axis : axes)
    if (axis->look && !has_views)
      perturbation.fail(fmt::format("an axis that keeps the view ({} changes it): environment {} has only one",
                                    axis->id, environment));
}

const PerturbationAxis* instructing_axis(const Scenario& scenario) {
  for (const Arm& arm : scenario.tests)
    for (const PerturbationAxis* axis : arm.axes)
      if (axis->other) return axis;
  return nullptr;
}

int command_given(const Scene& scene, const Scenario& scenario, std::optional<std::uint64_t> training_seed) {
  for (const PerturbationAxis* axis : scenario.arm(scene.arm).axes) {
    if (!axis->other) continue;
    RandomStream stream = perturbation_stream(axis->id, scene, training_seed);
    std::vector<int> added;
    for (std::size_t i = 0; i < scenario.commands.size(); ++i)
      if (scenario.commands[i].arm == scene.arm) added.push_back(static_cast<int>(i));
    return added.empty() ? axis->other(scene, scenario, stream)
                         : added[stream.below(static_cast<std::uint32_t>(added.size()))];
  }
  return scene.command;
}

bool means(const ScenarioCommand& command, const SceneObject& object) {
  return command.truth.target.belongs(object.object_type, object.texture);
}

std::string arm_of(const Perturbation& perturbation) {
  return fmt::format("{}_{}", perturbation.axis, perturbation.level);
}

RandomStream perturbation_stream(const std::string& axis, const Scene& scene,
                                 std::optional<std::uint64_t> training_seed, int step) {
  return RandomStream(fmt::format("perturbation/{}/{}/{}/{}{}/{}{}", axis, scene.scenario, scene.layout, scene.seed,
                                  own_stream(training_seed), scene.drawn_as(), later_stream(step)));
}

}  // namespace lgabench
