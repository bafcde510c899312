#include <lgabench/harness/suite.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/scenario_files.hpp>
#include <lgabench/core/scenario_path.hpp>
#include <lgabench/core/shipped.hpp>
#include <lgabench/harness/lists.hpp>
#include <lgabench/record/reference_rows.hpp>
#include <lgabench/record/suite_claims.hpp>

namespace lgabench {
namespace {

Json object_of(const JsonReader& value) {
  if (!value.json().is_object()) value.fail("an object");
  return value.json();
}

// An object whose members are among `known`, each read by `read`.
template <class Read>
auto members_of(const JsonReader& object, const std::vector<std::string>& known, Read read) {
  object.only(known);
  std::map<std::string, decltype(read(object))> all;
  for (const auto& member : object.json().items()) all.emplace(member.key(), read(object.at(member.key())));
  return all;
}

std::vector<std::string> names_of(const Json& object) {
  std::vector<std::string> all;
  for (const auto& member : object.items()) all.push_back(member.key());
  return all;
}

// `scenarios`: the suite's, with those that its variants make of them.
std::vector<SuiteArm> arms_of(const JsonReader& list, const std::vector<std::string>& scenarios) {
  std::vector<SuiteArm> arms;
  for (const JsonReader& reader : list.elements()) {
    SuiteArm arm{reader.at("arm").string(), reader.json()};
    if (reader.has("except")) arm.except = distinct_names(reader.at("except"), "scenario of the suite", scenarios);
    arm.members.erase("except");
    arms.push_back(std::move(arm));
  }
  return arms;
}

SuiteVariant variant_of(const JsonReader& reader, const std::vector<std::string>& scenarios) {
  reader.only({"train", "commands", "arms"});
  if (reader.json().empty()) reader.fail("\"train\", \"commands\" or \"arms\"");
  SuiteVariant variant;
  if (reader.has("train")) variant.train = object_of(reader.at("train"));
  if (reader.has("commands"))
    variant.commands = static_cast<std::size_t>(reader.at("commands").integer(1, largest_count));
  if (reader.has("arms")) variant.arms = arms_of(reader.at("arms"), scenarios);
  return variant;
}

std::map<std::string, std::vector<std::string>> groups_of(const JsonReader& reader,
                                                          const std::vector<std::string>& scenarios) {
  auto groups = members_of(reader, names_of(reader.json()),
                           [&](const JsonReader& list) { return distinct_names(list, "scenario", scenarios); });
  std::vector<std::string> grouped;
  for (const auto& group : groups) grouped.insert(grouped.end(), group.second.begin(), group.second.end());
  std::sort(grouped.begin(), grouped.end());
  if (std::adjacent_find(grouped.begin(), grouped.end()) != grouped.end())
    reader.fail("each scenario in one group at most");
  return groups;
}

// Those of the suite, and those that only a preset plays.
std::vector<std::string> played_scenarios(const Design& design, const Json& presets) {
  std::vector<std::string> played = design.scenarios;
  for (const Json& preset : presets)
    if (preset.is_object())
      for (const Json& scenario : preset.value("scenarios", Json::array()))
        if (scenario.is_string()) played.push_back(scenario.get<std::string>());
  return played;
}

// The suite's own design: all of it must be there.
Design design_of(const JsonReader& reader) {
  Json members = Json::object();
  for (const std::string& member : needed_design_members) members[member] = reader.at(member).json();
  for (const std::string& member : optional_design_members)
    if (reader.has(member)) members[member] = reader.at(member).json();
  return apply(JsonReader(members, reader.file()), Design{});
}

// What pages say of the suite (statistics/about_suite.hpp).
void expect_about(const JsonReader& about) {
  about.only({"title", "question", "main_arm", "main_demonstrations", "arms", "arm_titles", "rows", "presets"});
  about.at("question").string();
  if (about.has("title")) about.at("title").string();
  if (about.has("main_arm")) about.at("main_arm").string();
  if (about.has("main_demonstrations")) about.at("main_demonstrations").integer(1, largest_count);
  for (const char* name : {"arms", "arm_titles", "rows", "presets"}) {
    if (!about.has(name)) continue;
    const JsonReader words = about.at(name);
    if (!words.json().is_object()) words.fail("an object");
    for (const auto& one : words.json().items()) words.at(one.key()).string();
  }
}

// What the suite changes in its scenarios.
void read_changes(const JsonReader& reader, Suite& suite) {
  const std::vector<std::string>& listed = suite.design.scenarios;
  const std::vector<std::string> played = played_scenarios(suite.design, suite.presets);
  const auto json_of = [](const JsonReader& value) { return value.json(); };
  const auto named = [](const char* what, const std::vector<std::string>& known) {
    return [what, &known](const JsonReader& value) { return name_among(value, what, known); };
  };
  const std::vector<std::string> scenarios = scenario_ids();
  const std::vector<std::string>& files = shipped_answers();
  std::vector<std::string> with_variants = played;
  if (reader.has("variants"))
    for (const std::string& scenario : played)
      for (const std::string& variant : names_of(reader.at("variants").json()))
        with_variants.push_back(fmt::format("{}_{}", scenario, variant));
  if (reader.has("arms")) suite.arms = arms_of(reader.at("arms"), with_variants);
  if (reader.has("only_arms")) suite.only_arms = reader.at("only_arms").boolean();
  if (suite.only_arms && suite.arms.empty()) reader.at("only_arms").fail("\"arms\" beside it");
  if (reader.has("train")) suite.train = object_of(reader.at("train"));
  if (reader.has("near_miss")) suite.near_miss = members_of(reader.at("near_miss"), played, json_of);
  if (reader.has("scenes")) suite.scenes = members_of(reader.at("scenes"), played, object_of);
  if (reader.has("paraphrases"))
    suite.paraphrases = members_of(reader.at("paraphrases"), listed, named("scenario", scenarios));
  if (reader.has("answers")) suite.answers = members_of(reader.at("answers"), played, named("answers", files));
  if (reader.has("variants")) {
    const JsonReader variants = reader.at("variants");
    if (!variants.json().is_object() || variants.json().empty()) variants.fail("an object with a member");
    suite.variants = members_of(variants, names_of(variants.json()),
                                [&](const JsonReader& variant) { return variant_of(variant, with_variants); });
  }
}

// A shipped one, a file, or one on the scenario path.
fs::path suite_file(const std::string& id) {
  std::vector<std::string> known = shipped_names("suites");
  if (contains(known, id)) return data_directory() / "suites" / (id + ".json");
  if (fs::path(id).extension() == ".json") return id;
  for (const auto& [own, file] : files_on_scenario_path("scenarios")) {
    if (own == id) return file;
    known.push_back(own);
  }
  known.emplace_back("or a .json file");
  throw InputError(none_named("suite", id, known));
}

}  // namespace

Suite load_suite(const std::string& id) {
  const fs::path file = suite_file(id);
  const bool is_own = !is_shipped(file);
  const Json json = read_shipped_json(file);
  if (is_own) add_scenario_path(fs::absolute(file).parent_path());
  const JsonReader reader(json, file.string());
  std::vector<std::string> members = needed_design_members;
  members.insert(members.end(), optional_design_members.begin(), optional_design_members.end());
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
  suite.design = design_of(reader);
  suite.presets = reader.has("presets") ? object_of(reader.at("presets")) : Json::object();
  read_changes(reader, suite);
  if (reader.has("groups")) suite.groups = groups_of(reader.at("groups"), suite.design.scenarios);
  if (reader.has("selects_nothing")) suite.selects_nothing = distinct_names(reader.at("selects_nothing"));
  if (reader.has("references")) {
    std::vector<std::string> rows;
    for (const ReferenceRow& row : reference_rows())
      if (!row.in_every_suite) rows.push_back(row.id);
    suite.references = distinct_names(reader.at("references"), "reference row", rows);
  }
  if (reader.has("about")) {
    expect_about(reader.at("about"));
    if (is_own) suite.about = reader.at("about").json();
  }
  suite.claims = claims_beside(file);
  for (const std::string& preset : names_of(suite.presets)) preset_design(suite, preset);
  return suite;
}

std::string default_engine(const Catalogue& catalogue, const EnvironmentType& environment) {
  if (!environment.has_engine()) return own_engine;
  std::vector<const PluginInfo*> there;
  for (const PluginInfo& plugin : catalogue.plugins)
    if (plugin.kind == "engine") there.push_back(&plugin);
  if (there.empty()) throw InputError("no engine is installed (lgabench list)");
  for (const std::string& suite : shipped_names("suites"))
    for (const std::string& id : load_suite(suite).design.engines)
      for (const PluginInfo* engine : there)
        if (engine->id == id) return id;
  return there.front()->id;
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
    for (const SuiteArm& arm : suite.arms) arms.push_back(arm.id);
    distinct_names(overrides.at("arms"), "arm of the suite", arms);
  }
  return apply(overrides, suite.design);
}

}  // namespace lgabench
