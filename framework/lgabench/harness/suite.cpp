#include <lgabench/harness/suite.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/scenario_files.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/record/reference_rows.hpp>
#include <lgabench/record/suite_claims.hpp>

namespace lgabench {
namespace {

constexpr int most = 1'000'000;
constexpr long long largest_seed = std::numeric_limits<std::int64_t>::max();

// A list that names nothing twice, with each element read and checked by `read`.
template <class T, class Read>
std::vector<T> distinct(const JsonReader& list, Read read) {
  std::vector<T> all;
  for (const JsonReader& element : list.elements()) {
    const T value = read(element);
    if (std::find(all.begin(), all.end(), value) != all.end()) element.fail("each value once");
    all.push_back(value);
  }
  if (all.empty()) list.fail("at least one value");
  return all;
}

std::string one_of(const JsonReader& element, const char* what, const std::vector<std::string>& known) {
  const std::string name = element.string();
  if (!known.empty() && std::find(known.begin(), known.end(), name) == known.end())
    throw InputError(fmt::format("{}: {}: {}", element.file(), element.place(), none_named(what, name, known)));
  return name;
}

std::vector<std::string> names(const JsonReader& list, const char* what = "",
                               const std::vector<std::string>& known = {}) {
  return distinct<std::string>(list, [&](const JsonReader& element) { return one_of(element, what, known); });
}

const std::vector<std::string> grid_members{
    "scenarios",  "layouts",     "engines", "methods", "demonstrations",   "seeds",         "episodes",
    "scene_seed", "test_scenes", "smoke",   "options", "selection_errors", "perturbations", "train_on"};
const std::vector<std::string> may_be_absent{"test_scenes",      "smoke",         "options",
                                             "selection_errors", "perturbations", "train_on"};

// What a preset may say beside them: of the suite's arms, which are played.
std::vector<std::string> preset_members() {
  std::vector<std::string> members = grid_members;
  members.emplace_back("arms");
  return members;
}

// Method id or "*" -> option -> value, as far as it can be checked without plugins.
Json options_of(const JsonReader& options, const std::vector<std::string>& methods) {
  std::vector<std::string> known{"*"};
  for (const std::string& method : methods) known.push_back(row_id(method));
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

// Each line an axis and its levels, and the scenarios that do not play it.
Json perturbations_of(const JsonReader& list) {
  Json all = Json::array();
  std::vector<std::string> axes;
  for (const JsonReader& line : list.elements()) {
    line.only({"axis", "levels", "except"});
    const std::string axis = line.at("axis").string();
    if (std::find(axes.begin(), axes.end(), axis) != axes.end()) line.at("axis").fail("each axis once");
    axes.push_back(axis);
    const std::vector<int> levels = distinct<int>(line.at("levels"), [&](const JsonReader& level) {
      const Json one{{axis, level.json()}};
      return read_perturbation(JsonReader(one, list.file(), line.place())).level;
    });
    all.push_back({{"axis", axis}, {"levels", levels}});
    if (line.has("except")) all.back()["except"] = names(line.at("except"), "scenario", scenario_ids());
  }
  return all;
}

// An axis that changes what is perceived: what else one changes is no part of a demonstration.
TrainOn train_on_of(const JsonReader& reader) {
  const TrainOn through = read_train_on(reader);
  const std::vector<std::string> some = train_on_axes(), all = perturbation_ids();
  if (std::find(all.begin(), all.end(), through.axis) == all.end())
    throw InputError(fmt::format("{}: {}: {}", reader.file(), reader.place(), none_named("axis", through.axis, some)));
  if (std::find(some.begin(), some.end(), through.axis) == some.end())
    throw InputError(
        fmt::format("{}: {}: expected an axis that changes what is perceived and nothing else ({}), got {}",
                    reader.file(), reader.place(), fmt::join(some, ", "), through.axis));
  if (through.level) read_perturbation(reader);  // which refuses a level that the axis lacks
  return through;
}

// Each a scenario's first arm with these members changed.
Json arms_of(const JsonReader& list) {
  for (const JsonReader& arm : list.elements()) arm.at("arm").string();
  return list.json();
}

// What pages say of the suite (report/about_suite.hpp).
void expect_about(const JsonReader& about) {
  about.only({"title", "question", "main_arm", "main_demonstrations", "arms", "arm_titles", "rows", "presets"});
  about.at("question").string();
  if (about.has("title")) about.at("title").string();
  if (about.has("main_arm")) about.at("main_arm").string();
  if (about.has("main_demonstrations")) about.at("main_demonstrations").integer(1, most);
  for (const char* name : {"arms", "arm_titles", "rows", "presets"}) {
    if (!about.has(name)) continue;
    const JsonReader words = about.at(name);
    if (!words.json().is_object()) words.fail("an object");
    for (const auto& one : words.json().items()) words.at(one.key()).string();
  }
}

}  // namespace

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
  if (!design.perturbations.empty()) json["perturbations"] = design.perturbations;
  if (!design.arms.empty()) json["arms"] = design.arms;
  if (design.train_on) json["train_on"] = to_json(*design.train_on);
  return json;
}

Design apply(const JsonReader& overrides, Design design) {
  overrides.only(preset_members());
  if (overrides.has("scenarios")) design.scenarios = names(overrides.at("scenarios"), "scenario", scenario_ids());
  if (overrides.has("layouts")) design.layouts = names(overrides.at("layouts"), "layout", installed_layouts());
  if (overrides.has("engines")) design.engines = names(overrides.at("engines"));
  if (overrides.has("methods")) design.methods = names(overrides.at("methods"));
  if (overrides.has("demonstrations"))
    design.demonstrations = distinct<int>(overrides.at("demonstrations"),
                                          [](const JsonReader& n) { return static_cast<int>(n.integer(1, most)); });
  if (overrides.has("seeds"))
    design.seeds = distinct<std::uint64_t>(overrides.at("seeds"), [](const JsonReader& n) {
      return static_cast<std::uint64_t>(n.integer(0, largest_seed));
    });
  if (overrides.has("episodes")) design.episodes = static_cast<int>(overrides.at("episodes").integer(1, most));
  if (overrides.has("scene_seed"))
    design.scene_seed = static_cast<std::uint64_t>(overrides.at("scene_seed").integer(0, largest_seed));
  if (overrides.has("test_scenes")) design.test_scenes = read_test_scenes(overrides.at("test_scenes"));
  if (overrides.has("options")) {
    design.options = options_of(overrides.at("options"), design.methods);
    design.options_place = overrides.at("options").place();
  }
  if (overrides.has("selection_errors"))
    design.selection_errors = distinct<SelectionErrors>(overrides.at("selection_errors"), read_selection_errors);
  if (overrides.has("perturbations")) design.perturbations = perturbations_of(overrides.at("perturbations"));
  if (overrides.has("arms")) design.arms = names(overrides.at("arms"));
  if (overrides.has("train_on")) design.train_on = train_on_of(overrides.at("train_on"));
  if (overrides.has("smoke")) design.smoke = overrides.at("smoke").boolean();
  return design;
}

Suite load_suite(const std::string& id) {
  const bool is_file = fs::path(id).extension() == ".json";
  std::error_code none_to_list;
  auto known = json_names(data_directory() / "suites", none_to_list);
  if (!is_file && std::find(known.begin(), known.end(), id) == known.end()) {
    known.emplace_back("or a .json file");
    throw InputError(none_named("suite", id, known));
  }
  const fs::path file = is_file ? fs::path(id) : data_directory() / "suites" / (id + ".json");
  const Json json = read_json(file);
  if (is_file) add_scenario_path(fs::absolute(file).parent_path());
  const JsonReader reader(json, file.string());
  std::vector<std::string> members = grid_members;
  members.insert(members.end(),
                 {"id", "note", "about", "environment", "arms", "only_arms", "train", "near_miss", "scenes",
                  "paraphrases", "answers", "variants", "groups", "selects_nothing", "references", "presets"});
  reader.only(members);

  Suite suite;
  suite.file = file.string();
  suite.id = reader.at("id").string();
  if (suite.id != file.stem().string())
    reader.at("id").fail(fmt::format("\"{}\", as the file is named", file.stem().string()));
  suite.environment = reader.at("environment").string();
  Json own = Json::object();  // the suite's own design: all of it must be there
  for (const std::string& member : grid_members)
    if (reader.has(member) || std::count(may_be_absent.begin(), may_be_absent.end(), member) == 0)
      own[member] = reader.at(member).json();
  suite.design = apply(JsonReader(own, suite.file), Design{});
  if (reader.has("arms")) suite.arms = arms_of(reader.at("arms"));
  if (reader.has("only_arms")) suite.only_arms = reader.at("only_arms").boolean();
  if (suite.only_arms && suite.arms.empty()) reader.at("only_arms").fail("\"arms\" beside it");
  if (reader.has("train")) {
    if (!reader.at("train").json().is_object()) reader.at("train").fail("an object");
    suite.train = reader.at("train").json();
  }
  std::vector<std::string> played = suite.design.scenarios;  // by the suite or one of its presets
  for (const Json& preset : json.value("presets", Json::object()))
    if (preset.is_object())
      for (const Json& scenario : preset.value("scenarios", Json::array()))
        if (scenario.is_string()) played.push_back(scenario.get<std::string>());
  if (reader.has("near_miss")) {
    reader.at("near_miss").only(suite.design.scenarios);
    suite.near_miss = reader.at("near_miss").json();
  }
  if (reader.has("scenes")) {
    reader.at("scenes").only(played);
    suite.scenes = reader.at("scenes").json();
    for (const auto& [scenario, own_members] : suite.scenes.items())
      if (!own_members.is_object()) reader.at("scenes").at(scenario).fail("an object");
  }
  if (reader.has("paraphrases")) {
    reader.at("paraphrases").only(suite.design.scenarios);
    suite.paraphrases = reader.at("paraphrases").json();
    for (const auto& [scenario, ignored] : suite.paraphrases.items())
      one_of(reader.at("paraphrases").at(scenario), "scenario", scenario_ids());
  }
  if (reader.has("answers")) {
    reader.at("answers").only(played);
    suite.answers = reader.at("answers").json();
    for (const auto& [scenario, ignored] : suite.answers.items())
      one_of(reader.at("answers").at(scenario), "answers", json_names(data_directory() / "answers", none_to_list));
  }
  if (reader.has("variants")) {
    suite.variants = reader.at("variants").json();
    if (!suite.variants.is_object() || suite.variants.empty()) reader.at("variants").fail("an object with a member");
    for (const auto& [name, ignored] : suite.variants.items()) {
      const JsonReader variant = reader.at("variants").at(name);
      variant.only({"train", "commands", "arms"});
      if (variant.has("arms")) arms_of(variant.at("arms"));
      if (variant.has("commands")) variant.at("commands").integer(1, most);
      if (variant.has("train") && !variant.at("train").json().is_object()) variant.at("train").fail("an object");
      if (variant.json().empty()) variant.fail("\"train\", \"commands\" or \"arms\"");
    }
  }
  std::vector<std::string> with_variants = suite.design.scenarios;
  for (const std::string& scenario : suite.design.scenarios)
    for (const auto& [name, ignored] : suite.variants.items())
      with_variants.push_back(fmt::format("{}_{}", scenario, name));
  if (reader.has("arms"))
    for (const JsonReader& arm : reader.at("arms").elements())
      if (arm.has("except")) names(arm.at("except"), "scenario of the suite", with_variants);
  if (reader.has("groups")) {
    suite.groups = reader.at("groups").json();
    std::vector<std::string> grouped;
    for (const auto& [name, ignored] : suite.groups.items())
      for (const std::string& scenario : names(reader.at("groups").at(name), "scenario", suite.design.scenarios))
        grouped.push_back(scenario);
    std::sort(grouped.begin(), grouped.end());
    if (std::adjacent_find(grouped.begin(), grouped.end()) != grouped.end())
      reader.at("groups").fail("each scenario in one group at most");
  }
  if (reader.has("selects_nothing")) suite.selects_nothing = names(reader.at("selects_nothing"));
  if (reader.has("references")) {
    std::vector<std::string> asked_for;
    for (const ReferenceRow& row : reference_rows())
      if (!row.in_every_suite) asked_for.push_back(row.id);
    suite.references = names(reader.at("references"), "reference row", asked_for);
  }
  if (reader.has("about")) {
    expect_about(reader.at("about"));
    if (is_file) suite.about = reader.at("about").json();
  }
  suite.claims = claims_beside(file);
  suite.presets = reader.has("presets") ? reader.at("presets").json() : Json::object();
  if (!suite.presets.is_object()) reader.at("presets").fail("an object");
  for (const auto& preset : suite.presets.items()) preset_design(suite, preset.key());
  return suite;
}

const PluginInfo& usual_engine(const Catalogue& catalogue) {
  std::vector<const PluginInfo*> there;
  for (const PluginInfo& plugin : catalogue.plugins)
    if (plugin.kind == "engine") there.push_back(&plugin);
  if (there.empty()) throw InputError("no engine is installed (lgabench list)");
  std::error_code none_to_list;
  for (const std::string& suite : json_names(data_directory() / "suites", none_to_list))
    for (const std::string& id : load_suite(suite).design.engines)
      for (const PluginInfo* engine : there)
        if (engine->id == id) return *engine;
  return *there.front();
}

Design preset_design(const Suite& suite, const std::string& preset) {
  if (preset.empty()) return suite.design;
  if (!suite.presets.contains(preset)) {
    std::vector<std::string> known;
    for (const auto& item : suite.presets.items()) known.push_back(item.key());
    throw InputError(fmt::format("{}: {}", suite.file, none_named("preset", preset, known)));
  }
  const JsonReader overrides(suite.presets[preset], suite.file, "/presets/" + preset);
  if (overrides.has("arms")) {
    std::vector<std::string> arms;
    for (const Json& arm : suite.arms) arms.push_back(arm.at("arm"));
    names(overrides.at("arms"), "arm of the suite", arms);
  }
  return apply(overrides, suite.design);
}

}  // namespace lgabench
