#include <lgabench/harness/design.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include <lgabench/abstraction/reading.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/scenario_files.hpp>
#include <lgabench/harness/lists.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {
namespace {

constexpr long long largest_seed = std::numeric_limits<std::int64_t>::max();

// Method id or "*" -> option -> value, as far as it can be checked without plugins.
Json options_of(const JsonReader& options, const std::vector<std::string>& methods) {
  std::vector<std::string> known{"*"};
  for (const std::string& method : methods)
    if (!contains(known, row_id(method))) known.push_back(row_id(method));
  options.only(known);
  for (const auto& method : options.json().items()) {
    const JsonReader values = options.at(method.key());
    if (!values.json().is_object()) values.fail("an object");
    for (const auto& option : values.json().items())
      if (option.value().is_structured() || option.value().is_null())
        values.at(option.key()).fail("a text, a number, true or false");
  }
  return options.json();
}

std::vector<DesignAxis> perturbations_of(const JsonReader& list) {
  std::vector<DesignAxis> all;
  for (const JsonReader& line : list.elements()) {
    line.only({"axis", "levels", "except"});
    const std::string axis = line.at("axis").string();
    if (std::any_of(all.begin(), all.end(), [&](const DesignAxis& other) { return other.axis == axis; }))
      line.at("axis").fail("each axis once");
    all.push_back({axis, distinct_values<int>(line.at("levels"), [&](const JsonReader& level) {
                     const Json one{{axis, level.json()}};
                     return read_perturbation(JsonReader(one, list.file(), line.place())).level;
                   })});
    if (line.has("except")) all.back().except = distinct_names(line.at("except"), "scenario", scenario_ids());
  }
  return all;
}

Json to_json(const DesignAxis& axis) {
  Json json{{"axis", axis.axis}, {"levels", axis.levels}};
  if (axis.except) json["except"] = *axis.except;
  return json;
}

// An axis that changes what is perceived: what else one changes is no part of a demonstration.
TrainOn train_on_of(const JsonReader& reader) {
  const TrainOn through = read_train_on(reader);
  const std::vector<std::string> some = train_on_axes(), all = perturbation_ids();
  if (!contains(all, through.axis))
    throw InputError(fmt::format("{}: {}: {}", reader.file(), reader.place(), none_named("axis", through.axis, some)));
  if (!contains(some, through.axis))
    throw InputError(fmt::format("{}: {}: expected an axis that changes only the observation ({}), got {}",
                                 reader.file(), reader.place(), fmt::join(some, ", "), through.axis));
  if (through.level) read_perturbation(reader);  // which refuses a level that the axis lacks
  return through;
}

}  // namespace

const std::vector<std::string> needed_design_members{"scenarios",      "layouts", "engines",  "methods",
                                                     "demonstrations", "seeds",   "episodes", "scene_seed"};
const std::vector<std::string> optional_design_members{"test_scenes",   "smoke",    "options", "selection_errors",
                                                       "perturbations", "train_on", "names",   "segments"};

std::string name_among(const JsonReader& element, const char* what, const std::vector<std::string>& known) {
  const std::string name = element.string();
  if (!known.empty() && !contains(known, name))
    throw InputError(fmt::format("{}: {}: {}", element.file(), element.place(), none_named(what, name, known)));
  return name;
}

std::vector<std::string> distinct_names(const JsonReader& list, const char* what,
                                        const std::vector<std::string>& known) {
  return distinct_values<std::string>(list,
                                      [&](const JsonReader& element) { return name_among(element, what, known); });
}

std::vector<std::string> train_on_axes() {
  std::vector<std::string> ids;
  for (const PerturbationAxis& axis : perturbation_axes())
    if (axis.perceive) ids.push_back(axis.id);
  return ids;
}

Json to_json(const Design& design) {
  Json json{
      {"scenarios", design.scenarios}, {"layouts", design.layouts},       {"engines", design.engines},
      {"methods", design.methods},     {"seeds", design.seeds},           {"demonstrations", design.demonstrations},
      {"episodes", design.episodes},   {"scene_seed", design.scene_seed}, {"test_scenes", design.test_scenes},
      {"smoke", design.smoke},         {"options", design.options}};
  for (const SelectionErrors& errors : design.selection_errors) json["selection_errors"].push_back(to_json(errors));
  for (const DesignAxis& axis : design.perturbations) json["perturbations"].push_back(to_json(axis));
  if (!design.arms.empty()) json["arms"] = design.arms;
  if (design.train_on) json["train_on"] = to_json(*design.train_on);
  if (!design.names.empty()) json["names"] = design.names;
  if (!design.segments.empty()) json["segments"] = design.segments;
  return json;
}

Design apply(const JsonReader& overrides, Design design) {
  std::vector<std::string> members = needed_design_members;
  members.insert(members.end(), optional_design_members.begin(), optional_design_members.end());
  members.emplace_back("arms");
  overrides.only(members);
  if (overrides.has("scenarios"))
    design.scenarios = distinct_names(overrides.at("scenarios"), "scenario", scenario_ids());
  if (overrides.has("layouts")) design.layouts = distinct_names(overrides.at("layouts"));
  if (overrides.has("engines")) design.engines = distinct_names(overrides.at("engines"));
  if (overrides.has("methods")) design.methods = distinct_names(overrides.at("methods"));
  if (overrides.has("demonstrations"))
    design.demonstrations = distinct_values<int>(overrides.at("demonstrations"), [](const JsonReader& n) {
      return static_cast<int>(n.integer(0, largest_count));
    });
  if (overrides.has("seeds"))
    design.seeds = distinct_values<std::uint64_t>(overrides.at("seeds"), [](const JsonReader& n) {
      return static_cast<std::uint64_t>(n.integer(0, largest_seed));
    });
  if (overrides.has("episodes")) design.episodes = static_cast<int>(overrides.at("episodes").integer(1, largest_count));
  if (overrides.has("scene_seed"))
    design.scene_seed = static_cast<std::uint64_t>(overrides.at("scene_seed").integer(0, largest_seed));
  if (overrides.has("test_scenes")) design.test_scenes = read_test_scenes(overrides.at("test_scenes"));
  if (overrides.has("options")) {
    design.options = options_of(overrides.at("options"), design.methods);
    design.options_place = overrides.at("options").place();
  }
  if (overrides.has("selection_errors"))
    design.selection_errors = distinct_values<SelectionErrors>(overrides.at("selection_errors"), read_selection_errors);
  if (overrides.has("perturbations")) design.perturbations = perturbations_of(overrides.at("perturbations"));
  if (overrides.has("arms")) design.arms = distinct_names(overrides.at("arms"));
  if (overrides.has("train_on")) design.train_on = train_on_of(overrides.at("train_on"));
  if (overrides.has("names")) design.names = distinct_names(overrides.at("names"));
  if (overrides.has("segments"))
    design.segments = distinct_values<std::string>(overrides.at("segments"), read_segments);
  if (overrides.has("smoke")) design.smoke = overrides.at("smoke").boolean();
  return design;
}

}  // namespace lgabench
