// Suites, cells, run directories: what `lgabench` does before and after a worker.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <ctime>
#include <fstream>
#include <set>

#include <lgabench/core/hash.hpp>
#include <lgabench/harness/costs.hpp>
#include <lgabench/harness/expand.hpp>
#include <lgabench/harness/run_directory.hpp>
#include <lgabench/harness/schedule.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/harness/suite_scenario.hpp>
#include <lgabench/harness/worker_pool.hpp>
#include <tabletop/content.hpp>

#include "../engine_under_test.hpp"
#include "testing.hpp"

namespace lgabench {
namespace {

PluginInfo plugin(const std::string& kind, const std::string& id) {
  const auto option = [](const Json& usual) {
    return Json{{"default", usual}, {"help", "help"}, {"source", "test"}, {"framework", true}};
  };
  const Json options{{"epochs", option(750)}, {"rate", option(.5)}, {"loss", option("norm")}};
  return {"/none/" + id + ".so", kind, id, "0.1", "", "", options, sha256(id)};
}
Catalogue catalogue() { return {{plugin("method", "a"), plugin("method", "b"), plugin("engine", "e")}, {}}; }

Design small_grid() { return {{"heart", "letter"}, {"cells"}, {"e"}, {"a", "b"}, {10, 20}, {0, 1, 2}, 5, 7, false}; }

TEST(Expand, AsksThePeopleThatAMethodDeclares) {
  Catalogue known = catalogue();
  known.plugins[1].asks = "edit";
  Participant edits, specifies;
  edits.id = "one", specifies.id = "two";
  for (const char* id : {"heart", "letter"}) {
    const std::pair<std::string, std::string> command(id, load_scenario(id).commands[0].utterance);
    edits.answers[command].edited = Selection();
    specifies.answers[command].specified = Selection();
  }
  const std::vector<Cell> cells =
      expand(load_suite("q1"), small_grid(),
             {RecordedAnswers(), Json::object(), true, Truth::released, {edits, specifies}}, known);
  for (const Cell& cell : cells) {
    EXPECT_EQ(cell.participant.has_value(), cell.method.id == "b") << cell.title();
    if (cell.participant) {
      EXPECT_EQ(cell.participant->id, "one");
    }
    EXPECT_EQ(cell.method.asks, cell.method.id == "b" ? "edit" : "");
    EXPECT_EQ(to_json(cell).at("method").contains("asks"), cell.method.id == "b");
    EXPECT_EQ(to_json(read_cell(to_json(cell), "cell.json")), to_json(cell));
  }
}

TEST(Suite, q1) {
  const Suite suite = load_suite("q1");
  EXPECT_EQ(suite.design.scenarios.size(), 13u);
  EXPECT_EQ(suite.design.demonstrations, (std::vector<int>{10, 20, 30, 40, 50}));
  const Design smoke = preset_design(suite, "smoke");
  EXPECT_TRUE(smoke.smoke);
  EXPECT_EQ(smoke.scenarios, (std::vector<std::string>{"heart", "something_to_drink_water_out_of"}));
  EXPECT_EQ(smoke.demonstrations, std::vector<int>{5});
  const Design board = preset_design(suite, "leaderboard");
  EXPECT_FALSE(board.smoke);
  EXPECT_EQ(board.layouts, std::vector<std::string>{"continuous"});
  EXPECT_EQ(board.episodes, 100);
  EXPECT_EQ(board.seeds.size(), 3u);
  EXPECT_EQ(board.test_scenes, TestScenes::per_seed);
  EXPECT_EQ(board.options, suite.design.options);
  EXPECT_EQ(to_json(preset_design(suite, "paper")), to_json(suite.design)) << "the paper's setting is the suite's own";
  EXPECT_EQ(board.demonstrations.size(), 5u) << "what a preset does not name it takes from the suite";
}

TEST(Suite, SmokeTrainsAPolicyThatKeepsPlaces) {
  const Catalogue shipped = scan_plugins({shipped_plugin_directory()});
  std::error_code none_to_list;
  for (const std::string& id : json_names(data_directory() / "suites", none_to_list)) {
    const Suite suite = load_suite(id);
    for (const Cell& cell : expand(suite, preset_design(suite, "smoke"), {}, shipped))
      if (const Json policy = cell.method.options.value("policy", Json()); !cell.method.is_reference()) {
        EXPECT_TRUE(policy.is_null() || policy == "heat_map" || policy == "centroid" || policy == "point")
            << id << " " << cell.method.name;
      }
  }
}

TEST(Suite, GridAsJsonReadsBack) {
  const Json json = to_json(small_grid());
  EXPECT_EQ(to_json(apply(JsonReader(json, "test"), Design{})), json);
}

TEST(Cells, ExpandCrossesTheGrid) {
  const Suite suite = load_suite("q1");
  const auto cells = expand(suite, small_grid(), {}, catalogue());
  // 2 scenarios x (2 numbers x 3 seeds x (2 methods + constant action + most demonstrated) + random object + oracle)
  EXPECT_EQ(cells.size(), 2u * (2 * 3 * 4 + 2));
  std::vector<std::string> keys;
  for (const Cell& cell : cells) keys.push_back(key(cell));
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::unique(keys.begin(), keys.end()), keys.end()) << "two cells with one key";
  const auto oracles = std::count_if(cells.begin(), cells.end(), [](const Cell& c) { return c.method.id == "oracle"; });
  EXPECT_EQ(oracles, 2);
  for (const Cell& cell : cells) {
    if (cell.method.id == "oracle" || cell.method.id == "random_object") {
      EXPECT_EQ(cell.demonstrations, 0);
    }
  }
  EXPECT_EQ(expand(suite, small_grid(), {RecordedAnswers(), Json::object(), false}, catalogue()).size(),
            2u * 2 * 3 * 2);
}

TEST(Cells, OfOneScenarioShareIt) {
  std::set<const Json*> scenarios;
  for (const Cell& cell : expand(load_suite("q1"), small_grid(), {}, catalogue()))
    scenarios.insert(cell.scenario.get());
  EXPECT_EQ(scenarios.size(), 2u);
}

TEST(Suite, AddsItsArmsToThoseOfEveryScenario) {
  const Suite robustness = load_suite("robustness");
  Design design = small_grid();
  design.scenarios = load_suite("q1").design.scenarios;
  EXPECT_EQ(design.scenarios, robustness.design.scenarios);
  const auto cells = expand(robustness, design, {}, catalogue());
  for (const Cell& cell : cells) {
    const Scenario s = read_scenario(*cell.scenario, "cell");
    ASSERT_EQ(s.tests.size(), 6u);
    EXPECT_EQ(s.tests[0].id, "test");
    std::vector<tabletop::Content> scenes;
    for (const Arm& arm : s.tests) scenes.push_back(tabletop::content_of(*arm.scenes));
    EXPECT_FALSE(scenes[0].hard);
    EXPECT_TRUE(scenes[1].hard);
    EXPECT_EQ(scenes[1].later_letters, s.id == "letter") << "the rest is the first arm's";
    EXPECT_EQ(s.tests[4].label_noise, .2);
    EXPECT_EQ(s.tests[5].missed_segment, .1);
    for (std::size_t i = 2; i < 6; ++i)
      EXPECT_EQ(scenes[i].distractors, scenes[0].distractors) << "only what is seen differs";
  }
  Suite twice = robustness;
  twice.arms[1].members["arm"] = "hard";
  EXPECT_SAYS(message_of<InputError>([&] { expand(twice, design, {}, catalogue()); }),
              "/tests/2/arm: expected each arm once");
}

TEST(Suite, RowsWithoutASelectionArePlayedOnceWhateverItsErrors) {
  const Suite suite = load_suite("knowledge");
  std::map<std::string, std::set<std::string>> errors;
  for (const Cell& cell : expand(suite, preset_design(suite, "smoke"), {}, scan_plugins({shipped_plugin_directory()})))
    errors[cell.method.id].insert(cell.selection_errors.suffix());
  EXPECT_EQ(errors.at("lga").size(), 2u);
  EXPECT_EQ(errors.at("masked_bc").size(), 2u);
  EXPECT_EQ(errors.at("object_dropout"), std::set<std::string>{""});
}

TEST(Suite, AVariantMayHaveArmsAndAScenarioAnswersOfItsOwn) {
  const Scratch scratch("suite");
  Json json = read_json(data_directory() / "suites/few_members.json");
  json["id"] = "mine";
  json["scenarios"] = {"heart", "tiger_colored_object"};
  json["near_miss"] = {{"heart", json["near_miss"]["heart"]}};
  json["presets"] = Json::object();
  json["arms"].erase(json["arms"].begin() + 4, json["arms"].end());  // whose "except" names others
  json["variants"] = {{"usual", {{"train", {{"members", 2}}}}},
                      {"alone", {{"arms", {{{"arm", "nothing"}, {"distractors", {0, 0}}}}}}}};
  json["answers"] = {{"heart", "claude"}};
  const fs::path file = scratch.path / "mine.json";
  const auto load = [&] {
    write_file(file, json.dump());
    return load_suite(file.string());
  };
  const Suite suite = load();
  const auto arms = [&](const char* id) {
    std::vector<std::string> ids;
    for (const Arm& arm : suite_scenario(suite, id, Truth::released).tests) ids.push_back(arm.id);
    return ids;
  };
  EXPECT_EQ(arms("heart_alone"), std::vector<std::string>{"nothing_alone"});
  EXPECT_EQ(arms("heart_usual").size(), 4u);
  EXPECT_EQ(suite_scenario(suite, "heart_usual", Truth::released).recorded, "claude");
  EXPECT_EQ(suite_scenario(suite, "tiger_colored_object_usual", Truth::released).recorded,
            load_scenario("tiger_colored_object").recorded);
  json["answers"] = {{"heart", "nobody"}};
  EXPECT_SAYS(message_of<InputError>(load), "/answers/heart: no answers \"nobody\", expected one of: claude");
  json["answers"] = {{"red_heart", "claude"}};
  EXPECT_SAYS(message_of<InputError>(load), "/answers: unknown member \"red_heart\"");
  json.erase("answers");
  json["variants"]["alone"]["arms"][0].erase("arm");
  EXPECT_SAYS(message_of<InputError>(load), "/variants/alone/arms/0");
}

TEST(Suite, APresetPlaysTheArmsThatItNamesAndAnArmNamesWhoDoesNot) {
  const Suite suite = load_suite("few_members");
  const auto arms = [&](const char* id, const char* preset) {
    const Design design = preset_design(suite, preset);
    std::vector<std::string> ids;
    for (const Arm& arm : suite_scenario(suite, id, Truth::released, &design).tests) ids.push_back(arm.id);
    return ids;
  };
  using Ids = std::vector<std::string>;
  EXPECT_EQ(arms("heart_members_1", "abstraction"),
            Ids({"seen_members_1", "new_members_1", "seen_near_members_1", "new_near_members_1"}));
  EXPECT_EQ(arms("letter_from_the_word_letter_members_2", "abstraction_decisive"),
            Ids({"seen_near_members_2", "new_decisive_near_members_2", "new_other_near_members_2"}));
  EXPECT_EQ(arms("letter_from_the_word_letter_members_4", "abstraction_decisive"),
            Ids({"seen_near_members_4", "new_other_near_members_4"}));
  EXPECT_EQ(arms("heart_members_1", "abstraction_decisive"), Ids({"seen_near_members_1", "new_other_near_members_1"}));
  EXPECT_EQ(arms("heart_members_1", "").size(), 6u);

  const Scratch scratch("suite");
  const auto refusal = [&](const auto& change) {
    Json json = read_json(data_directory() / "suites/few_members.json");
    json["id"] = "mine";
    change(json);
    write_file(scratch.path / "mine.json", json.dump());
    return message_of<InputError>([&] { load_suite((scratch.path / "mine.json").string()); });
  };
  EXPECT_SAYS(refusal([](Json& json) { json["presets"]["abstraction"]["arms"] = {"old"}; }),
              "/presets/abstraction/arms/0: no arm of the suite \"old\"");
  EXPECT_SAYS(refusal([](Json& json) { json["arms"][4]["except"] = {"letter"}; }),
              "/arms/4/except/0: no scenario of the suite \"letter\"");
}

TEST(Cells, KeyIsOfTheWholeConfiguration) {
  const auto cells = expand(load_suite("q1"), small_grid(), {}, catalogue());
  const Cell& cell = cells.front();
  EXPECT_EQ(cell.method.options, Json({{"epochs", 750}, {"rate", .5}, {"loss", "norm"}}))
      << "defaults are part of a cell";
  EXPECT_EQ(key(read_cell(Json::parse(canonical(to_json(cell))), "test")), key(cell));
  EXPECT_EQ(key(cell), sha256(canonical(to_json(cell))).substr(0, 16));
  const Json json = to_json(cell);
  for (const auto& member : json.items()) {
    Json other = json;
    other[member.key()] = member.value().is_number() ? Json(91) : member.value().is_boolean() ? Json(true) : Json("x");
    if (member.key() == "test_scenes") other["test_scenes"] = "per_seed";
    if (member.key() == "scenario") other["scenario"] = {{"id", "x"}};
    if (member.key() == "method")
      other["method"] = {{"kind", "method"}, {"id", "x"}, {"name", "x"}, {"version", ""}, {"options", Json::object()}};
    EXPECT_NE(key(read_cell(other, "test")), key(cell)) << member.key();
  }
}

TEST(Cells, OptionsAreCheckedBeforeAnythingRuns) {
  const Suite suite = load_suite("q1");
  const auto with = [&](const Json& options) {
    expand(suite, small_grid(), {RecordedAnswers(), options, true}, catalogue());
  };
  EXPECT_NO_THROW(with({{"a", {{"epochs", 5}}}}));
  EXPECT_SAYS(message_of<InputError>([&] { with({{"a", {{"epoks", 5}}}}); }), "epoks");
  EXPECT_SAYS(message_of<InputError>([&] { with({{"c", {{"epochs", 5}}}}); }), "--set c");
  Design design = small_grid();
  design.methods = {"c"};
  EXPECT_THROW(expand(suite, design, {}, catalogue()), PluginError);
}

// Names of the rows that a design's methods make, with the number of epochs of each.
std::vector<std::string> rows(const std::vector<std::string>& methods, const Json& settings = Json::object()) {
  Design design{{"heart"}, {"cells"}, {"e"}, methods, {10}, {0}, 5, 7, false};
  std::vector<std::string> names;
  for (const Cell& cell : expand(load_suite("q1"), design, {RecordedAnswers(), settings, false}, catalogue()))
    names.push_back(cell.method.name + " " + canonical(cell.method.options.at("epochs")));
  return names;
}

TEST(Variants, AreNamedByWhatTellsThemFromOtherRowsOfTheirId) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(rows({"a", "a+loss=squared+epochs=5", "b+rate=0.5+loss=norm", "b+rate=1e+30"}),
            (Names{"a 750", "a+epochs=5+loss=squared 5", "b 750", "b+rate=1e+30 750"}));
  EXPECT_EQ(rows({"a", "a+rate=1"}), (Names{"a 750", "a+rate=1.0 750"})) << "a whole number for a fractional option";
  EXPECT_EQ(rows({"a+epochs=5+loss=squared", "b"}), (Names{"a 5", "b 750"})) << "nothing to tell it from";
  EXPECT_EQ(rows({"a+epochs=5+loss=squared", "a+epochs=6+loss=squared"}), (Names{"a+epochs=5 5", "a+epochs=6 6"}));
  EXPECT_EQ(rows({"a+epochs=750", "a+epochs=5"}), rows({"a", "a+epochs=5"})) << "however a row is written";
}

TEST(Variants, TakeSettingsOfTheirIdForWhatTheyDoNotSetThemselves) {
  EXPECT_EQ(rows({"a", "a+epochs=750", "a+loss=x", "b"}, {{"a", {{"epochs", 9}}}}),
            (std::vector<std::string>{"a 9", "a+epochs=750 750", "a+loss=x 9", "b 750"}));
}

TEST(DesignOptions, TheFirstGivenHolds) {
  const auto epochs = [](const std::string& method, const Json& settings, const Json& options) {
    Design design{{"heart"}, {"cells"}, {"e"}, {method}, {10}, {0}, 5, 7, false};
    design.options = options;
    return expand(load_suite("q1"), design, {RecordedAnswers(), settings, false}, catalogue())
        .front()
        .method.options.at("epochs")
        .get<int>();
  };
  const auto of = [](const char* id, int n) { return Json{{id, {{"epochs", n}}}}; };
  const auto both = [&](Json one, const Json& other) {
    one.update(other);
    return one;
  };
  EXPECT_EQ(epochs("a+epochs=1", both(of("a", 2), of("*", 3)), both(of("a", 4), of("*", 5))), 1);
  EXPECT_EQ(epochs("a", both(of("a", 2), of("*", 3)), both(of("a", 4), of("*", 5))), 2);
  EXPECT_EQ(epochs("a", of("*", 3), both(of("a", 4), of("*", 5))), 3);
  const Json none = Json::object();
  EXPECT_EQ(epochs("a", none, both(of("a", 4), of("*", 5))), 4);
  EXPECT_EQ(epochs("b", none, of("*", 5)), 5);
  EXPECT_EQ(epochs("a", none, none), 750);
}

// Expands a suite of the test's own that has these options in its preset "p"; method a lacks the option loss.
void expand_with(const Json& options) {
  const TemporaryDirectory directory;
  Json suite = read_json(data_directory() / "suites" / "q1.json");
  suite["methods"] = {"a", "b+epochs=5"};
  suite["engines"] = {"e"};
  suite.erase("options");
  suite["presets"] = {{"p", {{"options", options}}}};
  write_file(directory.path / "q1.json", canonical(suite));
  Catalogue shipped = catalogue();
  shipped.plugins[0].options.erase("loss");
  const Suite own = load_suite((directory.path / "q1.json").string());
  expand(own, preset_design(own, "p"), {}, shipped);
}

std::string refusal_of_options(const Json& options) {
  return message_of<InputError>([&] { expand_with(options); });
}

TEST(DesignOptions, AreRefusedWithTheirPlace) {
  EXPECT_NO_THROW(expand_with({{"*", {{"loss", "squared"}}}, {"b", {{"rate", 1}}}})) << "a has no loss";
  EXPECT_SAYS(refusal_of_options({{"c", {{"epochs", 5}}}}),
              "q1.json: /presets/p/options: unknown member \"c\", expected one of: *, a, b");
  EXPECT_SAYS(refusal_of_options({{"a", 5}}), "q1.json: /presets/p/options/a: expected an object");
  EXPECT_SAYS(refusal_of_options({{"a", {{"epochs", {5}}}}}), "q1.json: /presets/p/options/a/epochs: expected a text");
  EXPECT_SAYS(refusal_of_options({{"a", {{"epoks", 5}}}}), "q1.json: /presets/p/options/a: unknown member \"epoks\"");
  EXPECT_SAYS(refusal_of_options({{"*", {{"epoks", 5}}}}), "q1.json: /presets/p/options/*: unknown member \"epoks\"");
  EXPECT_SAYS(refusal_of_options({{"*", {{"epochs", "few"}}}}),
              "q1.json: /presets/p/options/*/epochs: expected a whole number");
}

// As plugin(), with an option `loss` of its own that takes one value.
Catalogue with_a_strangers(const std::string& id) {
  Catalogue known = catalogue();
  known.plugins.push_back(plugin("method", id));
  known.plugins.back().options["loss"] = {
      {"default", "huber"}, {"values", {"huber"}}, {"help", "its own"}, {"source", "test"}};
  return known;
}

TEST(DesignOptions, OfASuitesStarReachTheFrameworksOptionsAlone) {
  Suite suite = load_suite("q1");
  Design design{{"heart"}, {"cells"}, {"e"}, {"a", "mine"}, {10}, {0}, 5, 7, false};
  design.options = {{"*", {{"loss", "squared"}, {"epochs", 5}}}};
  const auto cells_with = [&](const Json& settings) {
    return expand(suite, design, {RecordedAnswers(), settings, false}, with_a_strangers("mine"));
  };
  const std::vector<Cell> cells = cells_with(Json::object());
  EXPECT_EQ(cells.at(0).method.options, Json({{"epochs", 5}, {"rate", .5}, {"loss", "squared"}}));
  EXPECT_EQ(cells.at(1).method.options, Json({{"epochs", 5}, {"rate", .5}, {"loss", "huber"}}));
  EXPECT_SAYS(message_of<InputError>([&] {
                cells_with({{"*", {{"loss", "squared"}}}});
              }),
              "--set: /*/loss: expected one of [\"huber\"]");
  EXPECT_EQ(cells_with({{"*", {{"loss", "huber"}}}}).at(0).method.options.at("loss"), "huber")
      << "the command line knows whom it speaks to";
  design.options = {{"mine", {{"loss", "squared"}}}};
  EXPECT_SAYS(message_of<InputError>([&] { cells_with(Json::object()); }), "/options/mine/loss: expected one of");

  Catalogue strangers = with_a_strangers("mine");
  for (PluginInfo& info : strangers.plugins)
    if (info.id != "mine") info.options.erase("loss");
  design.options = {{"*", {{"loss", "huber"}}}};
  EXPECT_SAYS(message_of<InputError>([&] { expand(suite, design, {}, strangers); }),
              "/options/*: unknown member \"loss\"");
}

TEST(Layouts, ThatAScenarioLacksAreRefusedBeforeAnythingRuns) {
  for (const auto& [id, wrong, there] :
       {std::array{"mobile", "cells", "table"}, std::array{"q1", "table", "cells, continuous, released"}}) {
    const Suite suite = load_suite(id);
    Design design = suite.design;
    design.methods = {"a"}, design.engines = {"e"}, design.options = Json::object();
    EXPECT_NO_THROW(expand(suite, design, {}, catalogue()));
    design.layouts.push_back(wrong);
    const std::string said = message_of<InputError>([&] { expand(suite, design, {}, catalogue()); });
    EXPECT_SAYS(said, fmt::format("scenario {} (", design.scenarios.front()));
    EXPECT_SAYS(said, fmt::format("no layout \"{}\", expected one of: {}", wrong, there));
  }
}

TEST(TestScenes, PerSeedGiveEachTrainingSeedItsOwn) {
  Design design = small_grid();
  const std::vector<Cell> shared = expand(load_suite("q1"), design, {}, catalogue());
  design.test_scenes = TestScenes::per_seed;
  const std::vector<Cell> own = expand(load_suite("q1"), design, {}, catalogue());
  // 2 scenarios x (2 numbers x 3 seeds x (2 methods + constant action + most demonstrated) + 3 seeds x (random object +
  // oracle))
  EXPECT_EQ(own.size(), 2u * (2 * 3 * 4 + 3 * 2));
  EXPECT_EQ(shared.front().scenes_of_seed(), std::nullopt);
  std::set<std::uint64_t> oracles;
  for (const Cell& cell : own) {
    EXPECT_EQ(cell.scenes_of_seed(), cell.training_seed);
    EXPECT_EQ(key(read_cell(to_json(cell), "test")), key(cell));
    if (cell.method.id == "oracle") oracles.insert(cell.training_seed);
  }
  EXPECT_EQ(oracles, (std::set<std::uint64_t>{0, 1, 2}));
  Json old = to_json(shared.front());
  old.erase("test_scenes");
  EXPECT_EQ(read_cell(old, "test").test_scenes, TestScenes::shared) << "a cell of 0.1";
  old["test_scenes"] = "mine";
  EXPECT_SAYS(message_of<InputError>([&] { read_cell(old, "test"); }), "/test_scenes: expected shared or per_seed");
}

TEST(TrainOn, IsASettingOfMethodsAlone) {
  Design design = small_grid();
  const std::vector<Cell> without = expand(load_suite("q1"), design, {}, catalogue());
  EXPECT_FALSE(to_json(design).contains("train_on"));
  const auto with = [&](const Json& through) {
    const Json json{{"train_on", through}};
    return apply(JsonReader(json, "mine"), design);
  };
  for (const auto& [through, level] :
       {std::pair(Json{{"sensor_noise", 2}}, std::optional(2)), {Json{{"sensor_noise", "any"}}, std::nullopt}}) {
    EXPECT_EQ(to_json(with(through))["train_on"], through);
    const std::vector<Cell> cells = expand(load_suite("q1"), with(through), {}, catalogue());
    ASSERT_EQ(cells.size(), without.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      EXPECT_EQ(key(cells[i]) == key(without[i]), cells[i].method.is_reference());
      EXPECT_EQ(cells[i].needs_axes(), !cells[i].method.is_reference());
      EXPECT_EQ(read_cell(to_json(cells[i]), "test").train_on, cells[i].train_on);
      EXPECT_EQ(cells[i].train_on ? cells[i].train_on->level : level, level);
    }
  }
  const auto refusal = [&](const Json& through) { return message_of<InputError>([&] { with(through); }); };
  EXPECT_SAYS(refusal({{"selection_errors", 1}}),
              "mine: /train_on: expected an axis that changes only the observation (light_intensity, ");
  EXPECT_SAYS(refusal({{"all", 1}}), ", got all");
  EXPECT_SAYS(refusal({{"sensor", 1}}), "no axis \"sensor\" (did you mean \"sensor_noise\"?)");
  EXPECT_SAYS(refusal({{"sensor_noise", 5}}), "/train_on/sensor_noise: expected a level from 1 to 4 (");
  EXPECT_SAYS(refusal({{"sensor_noise", "every"}}), "/train_on/sensor_noise: expected a level, or \"any\"");
}

TEST(PlayedArms, LeaveTheOthersInTheScenarioUnplayed) {
  const Suite suite = load_suite("perturbations");
  Design design = suite.design;
  design.scenarios = {"heart"}, design.engines = {"e"}, design.methods = {"a"}, design.options = Json::object();
  const auto cells = [&](const std::optional<PlayedArms>& played) {
    Variation variation{NoAnswers()};
    variation.played = played;
    return expand(suite, design, variation, catalogue());
  };
  const std::vector<Cell> whole = cells({});
  EXPECT_FALSE(whole.front().scenario->contains("played"));
  const PlayedArms some{{{"object_size", {2, 4}}, {"light_colour", {}}}, {"paraphrase_3"}};
  const std::vector<Cell> part = cells(some);
  ASSERT_EQ(part.size(), whole.size());
  EXPECT_EQ(part.front().scenario->at("played"),
            Json({"control", "object_size_2", "object_size_4", "paraphrase_3", "light_colour_1", "light_colour_2",
                  "light_colour_3", "light_colour_4"}));
  EXPECT_NE(key(part.front()), key(whole.front()));
  Json others = *part.front().scenario;
  others.erase("played");
  EXPECT_EQ(others, *whole.front().scenario) << "world and commands are the whole suite's";
  EXPECT_EQ(usual_seconds(part.front()) < usual_seconds(whole.front()), true);
  EXPECT_EQ(to_json(some)["axes"][0], Json({{"axis", "object_size"}, {"levels", {2, 4}}}));
  EXPECT_EQ(played_arms(others).size(), others["tests"].size());

  others["played"] = {"object_size_2"};
  const auto read = [&] { return message_of<InputError>([&] { read_scenario(others, "mine"); }); };
  EXPECT_SAYS(read(), "mine: /played: expected the first arm among them");
  others["played"] = {"control", "moon"};
  EXPECT_SAYS(read(), "mine: /played/1: expected an arm of \"tests\"");
  const auto refusal = [&](const PlayedArms& played) { return message_of<InputError>([&] { cells(played); }); };
  EXPECT_SAYS(refusal({{{"sensor", {}}}, {}}), "--axes: no axis \"sensor\" (did you mean \"sensor_noise\"?)");
  EXPECT_SAYS(refusal({{{"all", {5}}}, {}}), "--axes: all has no level 5 here, expected one of: 1, 2, 3, 4");
  EXPECT_SAYS(refusal({{}, {"moon"}}), "--arms: no arm \"moon\", expected one of 65, such as: control, ");
}

TEST(Names, AreASettingOfMethodsAloneAndNameTheRow) {
  Design design = small_grid();
  const std::vector<Cell> without = expand(load_suite("q1"), design, {}, catalogue());
  EXPECT_FALSE(to_json(design).contains("names"));
  const auto with = [&](const Json& json) { return apply(JsonReader(json, "mine"), design); };
  const auto cells_of = [&](const Json& json) { return expand(load_suite("q1"), with(json), {}, catalogue()); };
  const auto keys = [](const std::vector<Cell>& cells) {
    std::vector<std::string> all;
    for (const Cell& cell : cells) all.push_back(key(cell));
    return all;
  };
  EXPECT_EQ(keys(cells_of({{"names", {"simulator"}}, {"segments", {"simulator"}}})), keys(without));
  const std::vector<Cell> cells =
      cells_of({{"names", {"simulator", "read"}}, {"segments", {"difference", "simulator"}}});
  std::map<std::string, std::set<std::string>> rows;
  std::size_t methods = 0, references = 0;
  for (const Cell& cell : without) ++(cell.method.is_reference() ? references : methods);
  for (const Cell& cell : cells) {
    rows[cell.method.id].insert(cell.method.name);
    EXPECT_EQ(read_cell(to_json(cell), "test").reading, cell.reading);
    EXPECT_EQ(key(read_cell(to_json(cell), "test")), key(cell));
    EXPECT_EQ(to_json(cell).contains("names"), cell.reading.names == "read");
    EXPECT_EQ(cell.data.contains("reader"), cell.reading.names == "read");
  }
  EXPECT_EQ(cells.size(), 4 * methods + references);
  EXPECT_EQ(rows["a"],
            (std::set<std::string>{"a", "a+names=read", "a+segments=difference", "a+names=read+segments=difference"}));
  EXPECT_EQ(rows["oracle"], std::set<std::string>{"oracle"});

  const auto refusal = [&](const char* suite, Json json) {
    json.update({{"methods", {"a"}}, {"engines", design.engines}, {"options", Json::object()}});
    return message_of<InputError>(
        [&] { expand(load_suite(suite), apply(JsonReader(json, "mine"), load_suite(suite).design), {}, catalogue()); });
  };
  EXPECT_SAYS(refusal("q1", {{"names", {"raed"}}}), "no names or perceiver \"raed\" (did you mean \"read\"?)");
  EXPECT_SAYS(refusal("q1", {{"segments", {"colour"}}}), "/segments/0: expected \"simulator\" or \"difference\"");
  EXPECT_SAYS(refusal("robustness", {{"names", {"read"}}}), "makes errors in the names, which reading would overwrite");
  EXPECT_SAYS(refusal("mobile", {{"names", {"read"}}}), "no reader was trained on pictures of mobile");
}

TEST(Variants, RefuseOneRowTwiceAndWhatIsNoVariant) {
  const auto refusal = [](const std::vector<std::string>& methods) {
    return message_of<InputError>([&] { rows(methods); });
  };
  EXPECT_SAYS(refusal({"a", "b", "a+epochs=750"}), "\"a\" and \"a+epochs=750\" are the same row, a;");
  EXPECT_SAYS(refusal({"a+loss=x+epochs=5", "a+epochs=5+loss=x"}), "the same row, a;");
  for (const char* malformed : {"a+", "a+5", "a+loss", "a+loss+epochs=5", "a+loss=x+", "a+epochs=5+epochs=6"})
    EXPECT_SAYS(refusal({malformed}), "expected ID+OPTION=VALUE+...");
  EXPECT_SAYS(refusal({"a+epoks=5"}), "epoks");
  EXPECT_SAYS(refusal({"a+epochs=few"}), "expected a whole number");
  EXPECT_THROW(rows({"c+epochs=5"}), PluginError);
}

TEST(Variants, RefuseTheIdOfAReferenceRow) {
  Catalogue named = catalogue();
  named.plugins[0].id = "oracle";
  const Design design{{"heart"}, {"cells"}, {"e"}, {"oracle"}, {10}, {0}, 5, 7, false};
  EXPECT_SAYS(message_of<InputError>([&] { expand(load_suite("q1"), design, {}, named); }),
              "methods: \"oracle\" is a reference row; expected a method of another id");
}

TEST(Variants, EveryShippedSuiteExpandsWithTheShippedPlugins) {
  const Catalogue shipped = scan_plugins({shipped_plugin_directory()});
  for (const std::string id : {"factorial", "q1", "q1_long", "q2", "q3", "robustness"}) {
    const Suite suite = load_suite(id);
    if (id[0] != 'q' || id == "q1_long") {
      EXPECT_EQ(suite.design.scenarios, load_suite("q1").design.scenarios) << id;
    }
    for (const std::string preset : {"", "smoke", "paper", "paper_text", "leaderboard"}) {
      Design design = preset_design(suite, preset);
      design.engines = {engine_under_test().id};
      const std::size_t seeds = design.seeds.size(), sets = scene_sets(design.test_scenes, design.seeds).size();
      const std::size_t each = design.demonstrations.size() * seeds * (design.methods.size() + 2) + 2 * sets;
      EXPECT_EQ(expand(suite, design, {}, shipped).size(), design.scenarios.size() * each) << id << " " << preset;
    }
  }
  const Suite mobile = load_suite("mobile");
  for (const std::string preset : {"", "smoke", "paper", "leaderboard"}) {
    Design design = preset_design(mobile, preset);
    design.engines = {engine_under_test().id};
    EXPECT_EQ(design.test_scenes, TestScenes::per_seed) << "same_place is near each seed's own first demonstration";
    const std::size_t seeds = design.seeds.size();
    const std::size_t each = design.demonstrations.size() * seeds * (design.methods.size() + 2) + 2 * seeds;
    EXPECT_EQ(expand(mobile, design, {}, shipped).size(), design.scenarios.size() * each) << preset;
  }
  Design smoke = preset_design(load_suite("factorial"), "smoke");
  smoke.engines = {engine_under_test().id};
  std::set<std::string> pairs;
  for (const Cell& cell : expand(load_suite("factorial"), smoke, {}, shipped))
    if (!cell.method.is_reference())
      pairs.insert(cell.method.options.at("scenes").get<std::string>() + " " +
                   cell.method.options.at("input").get<std::string>());
  EXPECT_EQ(pairs.size(), 7u) << "both scenes with each input but object_mask, which has one";
}

TEST(Variants, OfThePaperAndItsAppendixHaveTheirSettings) {
  const Catalogue shipped = scan_plugins({shipped_plugin_directory()});
  for (const std::string id : {"factorial", "q1", "q1_long", "q2", "q3", "robustness"})
    for (const std::string preset : {"paper", "paper_text"}) {
      Design design = preset_design(load_suite(id), preset);
      design.engines = {engine_under_test().id};
      EXPECT_EQ(design.layouts, std::vector<std::string>{preset == "paper" ? "continuous" : "cells"}) << id;
      for (const Cell& cell : expand(load_suite(id), design, {}, shipped)) {
        const Json& options = cell.method.options;
        if (cell.method.is_reference()) continue;
        EXPECT_EQ(options.at("network"), "text") << id << " " << preset << " " << cell.method.name;
        EXPECT_EQ(options.at("loss"), preset == "paper" ? "norm" : "squared") << id << " " << cell.method.name;
        if (options.contains("picture")) {
          EXPECT_EQ(options.at("picture"), preset == "paper" ? "none" : "rgb") << id << " " << cell.method.name;
        }
      }
    }
}

struct RunDirectories : testing::Test, TemporaryDirectory {};

RunRecord run_of(const std::vector<std::string>& keys) {
  RunRecord run;
  run.cells = keys;
  run.request = {{"episodes", static_cast<int>(keys.size())}};
  run.machine = {{"processor", "a processor"}};
  return run;
}

const std::string cell_text = "{\"n\":1}\n";
const std::string k = sha256("{\"n\":1}").substr(0, 16);  // the key of a cell that reads so
const std::string l(16, 'a');                             // of another

// What a worker leaves behind.
void finish(const fs::path& cell, const Json& build) {
  Json files = Json::object();
  for (const std::string name : {"cell.json", "selection.json", "training.jsonl", "episodes.jsonl", "timing.json"}) {
    const std::string bytes = name == "cell.json" ? cell_text : "{}\n";
    write_file(cell / name, bytes);
    files[name] = sha256(bytes);
  }
  write_file(cell / "status.json", canonical({{"state", "ok"}, {"build", build}, {"files", files}}));
}

TEST_F(RunDirectories, ACellIsCompleteWithItsBuildAndItsBytes) {
  const Json build{{"worker", "1"}, {"engine", "2"}};
  const RunDirectory directory(path / "run", run_of({k}), Existing::same);
  EXPECT_EQ(directory.state(k, build).why, "") << "never begun";
  finish(directory.scratch(k), build);
  EXPECT_FALSE(directory.state(k, build).complete) << "not yet kept";
  directory.keep(k);
  EXPECT_TRUE(directory.state(k, build).complete) << directory.state(k, build).why;
  EXPECT_TRUE(directory.state(k, {{"worker", "1"}, {"engine", "3"}}).other_build);
  std::ofstream(directory.cell(k) / "episodes.jsonl") << "{\"success\": true}\n";
  const auto state = directory.state(k, build);
  EXPECT_FALSE(state.complete);
  EXPECT_SAYS(state.why, "episodes.jsonl");
  write_file(directory.cell(k) / "status.json", "{\"state\": ");
  EXPECT_FALSE(directory.state(k, build).complete) << "a broken status is no result";
  fs::remove(directory.cell(k) / "status.json");
  EXPECT_SAYS(directory.state(k, build).why, "status.json: cannot be read");
  finish(directory.cell("0123456789abcdef"), build);
  EXPECT_SAYS(directory.state("0123456789abcdef", build).why, "cell.json changed since it was written");
}

TEST_F(RunDirectories, ResumingWithAnotherBuildSaysSoInRunJson) {
  RunRecord run = run_of({k});
  run.build = {{"worker", "1"}};
  { const RunDirectory directory(path / "run", run, Existing::same); }
  run.build = {{"worker", "2"}};
  { const RunDirectory directory(path / "run", run, Existing::same); }
  EXPECT_EQ(read_run_record(path / "run").build["worker"], "1") << "its cells are still the first build's";
  { const RunDirectory directory(path / "run", run, Existing::resume); }
  EXPECT_EQ(read_json(path / "run/run.json"), to_json(run));
}

TEST_F(RunDirectories, KeepingReplacesAnEarlierAttempt) {
  const RunDirectory directory(path / "run", run_of({k}), Existing::same);
  write_file(directory.scratch(k) / "old", "");
  directory.keep(k);
  write_file(directory.scratch(k) / "new", "");
  directory.keep(k);
  EXPECT_TRUE(fs::exists(path / "run/cells" / k / "new"));
  EXPECT_FALSE(fs::exists(path / "run/cells" / k / "old"));
  EXPECT_EQ(std::distance(fs::directory_iterator(path / "run/cells"), fs::directory_iterator()), 1);
}

TEST_F(RunDirectories, HalfWrittenCellsGoAndOthersStay) {
  {
    const RunDirectory directory(path / "run", run_of({k}), Existing::same);
    write_file(directory.scratch("half") / "cell.json", "{}");
    write_file(directory.scratch(k) / "cell.json", "{}");
    directory.keep(k);
  }
  const RunDirectory again(path / "run", run_of({k}), Existing::same);
  EXPECT_TRUE(fs::exists(path / "run/cells" / k / "cell.json"));
  EXPECT_EQ(std::distance(fs::directory_iterator(path / "run/cells"), fs::directory_iterator()), 1);
}

TEST_F(RunDirectories, RefusesWhatIsNotItsOwn) {
  {
    const RunDirectory directory(path / "run", run_of({k}), Existing::same);
    EXPECT_SAYS(message_of<InputError>([&] { RunDirectory(path / "run", run_of({k}), Existing::same); }),
                "another run is writing");
  }
  for (const Existing existing : {Existing::same, Existing::resume}) {
    EXPECT_SAYS(message_of<InputError>([&] {
                  RunDirectory(path / "run", run_of({k, l}), existing);
                }),
                "episodes 1 there, 2 wanted");
  }
  write_file(path / "other/letter.txt", "kept");
  for (const Existing existing : {Existing::same, Existing::resume, Existing::fresh}) {
    EXPECT_SAYS(message_of<InputError>([&] { RunDirectory(path / "other", run_of({k}), existing); }), "not a run");
  }
  EXPECT_SAYS(message_of<InputError>([&] { RunDirectory(path / "other/letter.txt/run", run_of({}), Existing::same); }),
              "letter.txt is not a directory");
  EXPECT_EQ(read_file(path / "other/letter.txt"), "kept");
}

TEST_F(RunDirectories, FreshDropsTheRunAndNothingElse) {
  {
    const RunDirectory directory(path / "run", run_of({k}), Existing::same);
    finish(directory.scratch(k), Json::object());
    directory.keep(k);
    write_file(path / "run/notes.txt", "kept");
  }
  const RunDirectory directory(path / "run", run_of({k, l}), Existing::fresh);
  EXPECT_FALSE(fs::exists(path / "run/cells" / k));
  EXPECT_EQ(read_json(path / "run/run.json"), to_json(run_of({k, l})));
  EXPECT_EQ(read_file(path / "run/notes.txt"), "kept");
}

std::vector<Cell> cells_to_play() {
  std::vector<Cell> cells;
  for (const std::string scenario : {"a", "b", "c"})
    for (const int n : {10, 50})
      for (const char* method : {"quick", "slow"}) {
        Cell cell;
        cell.scenario = std::make_shared<const Json>(Json{{"id", scenario}, {"task", "pick_and_place"}});
        cell.environment = "tabletop";
        cell.method.id = cell.method.name = method;
        cell.demonstrations = n;
        cells.push_back(cell);
      }
  return cells;
}

TEST(Workers, ThatCannotBeStartedEndTheirOwnTaskAlone) {
  std::vector<std::string> reasons;
  const PoolEvents events{[](std::size_t) {}, [](std::size_t, const std::string&, long long) {},
                          [&](std::size_t, const WorkerEnd& end) { reasons.push_back(end.complaint->reason); }, [] {}};
  const auto make = [](std::size_t i) -> WorkerTask {
    if (i == 0) throw InputError("no file");
    throw fs::filesystem_error("no directory", std::make_error_code(std::errc::no_space_on_device));
  };
  EXPECT_TRUE(run_workers(2, make, {}, events));
  ASSERT_EQ(reasons.size(), 2u);
  EXPECT_EQ(reasons[0], "no file");
  EXPECT_SAYS(reasons[1], "no directory");
}

TEST(Shards, ArePartsWithAShareOfEachKindOfCell) {
  const std::vector<Cell> cells = cells_to_play();
  for (const int count : {1, 2, 3, 5, 20}) {
    std::set<const Cell*> all;
    std::set<std::size_t> sizes;
    for (int i = 1; i <= count; ++i) {
      const auto part = cells_of(cells, {i, count});
      EXPECT_EQ(part, cells_of(cells, {i, count}));
      all.insert(part.begin(), part.end());
      sizes.insert(part.size());
      const auto slow = std::count_if(part.begin(), part.end(), [](const Cell* cell) {
        return cell->method.id == "slow" && cell->demonstrations == 50;
      });
      EXPECT_LE(slow, (3 + count - 1) / count) << "of three";
      EXPECT_GE(slow, 3 / count);
    }
    EXPECT_EQ(all.size(), cells.size()) << count;
    EXPECT_LE(*sizes.rbegin() - *sizes.begin(), 1u) << count;
  }
  EXPECT_EQ(read_shard("3/12").index, 3);
  EXPECT_EQ(read_shard("3/12").count, 12);
  for (const char* bad : {"", "1", "/", "1/", "0/1", "2/1", "-1/2", "1/2 ", "1/99999999999", "a/b"})
    EXPECT_SAYS(message_of<InputError>([&] { read_shard(bad); }), "expected i/n");
}

TEST(Schedules, GiveLongCellsFirstOnceTheyAreKnown) {
  const std::vector<Cell> cells = cells_to_play();
  Schedule schedule(cells_of(cells, {}));
  const Cell* first = schedule.next();
  EXPECT_EQ(first->method.id + std::to_string(first->demonstrations), "quick50");
  schedule.learn(*first, 5.);  // .1 s a demonstration
  const Cell* unknown = schedule.next();
  EXPECT_EQ(unknown->method.id + std::to_string(unknown->demonstrations), "slow50") << "it may take long";
  schedule.learn(*unknown, 100.);  // 2 s a demonstration: ten take longer than the other's fifty
  std::string order;
  for (int i = 0; i < 10; ++i) {
    const Cell* cell = schedule.next();
    order += fmt::format("{}{} ", cell->method.id, cell->demonstrations);
  }
  EXPECT_EQ(order, "slow50 slow50 slow10 slow10 slow10 quick50 quick50 quick10 quick10 quick10 ");
}

TEST(Schedules, MayGiveCellsInAnOrderThatIsDrawn) {
  const std::vector<Cell> cells = cells_to_play();
  const auto order = [&cells](std::uint32_t drawn_by) {
    Schedule schedule(cells_of(cells, {}), drawn_by);
    std::vector<const Cell*> all;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      all.push_back(schedule.next());
      schedule.learn(*all.back(), 1. + static_cast<double>(i));  // has no part in it
    }
    return all;
  };
  const std::vector<const Cell*> one = order(1);
  EXPECT_EQ(order(1), one);
  EXPECT_NE(order(2), one);
  EXPECT_EQ(std::set<const Cell*>(one.begin(), one.end()).size(), cells.size());
}

// Would take minutes if each cell were looked for among all.
// Whose process did not go on: the plugin's that was awaited, or the worker's own, where engine and environment run.
TEST(WorkerEnds, NameTheProcessThatDidNotGoOn) {
  const std::string itself = " of the worker itself, in which engine and environment run";
  WorkerEnd hung{5, 0, 0, true, "demonstrate", ""};
  EXPECT_EQ(why_it_ended(hung, 5).reason, "stopped after 5 s in phase demonstrate" + itself);
  hung.waits_for = "plugin mine (method)";
  EXPECT_EQ(why_it_ended(hung, 5).reason,
            "stopped after 5 s in phase demonstrate: plugin mine (method) did not answer");
  EXPECT_EQ(why_it_ended({1, 0, 0, false, "evaluate", ""}, 5).reason, "exited with 0 in phase evaluate" + itself);
  EXPECT_SAYS(why_it_ended({1, 0, SIGSEGV, false, "evaluate", ""}, 5).reason, " in phase evaluate" + itself);
  const WorkerFault killed = why_it_ended({1, 0, SIGKILL, false, "evaluate", ""}, 5);
  EXPECT_EQ(killed.fault, "host");
  EXPECT_SILENT(killed.reason, "itself");
}

TEST(Schedules, OfAHundredThousandCellsAreGivenInSeconds) {
  std::vector<Cell> cells(100'000, cells_to_play().front());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i].method.name = fmt::format("row{}", i % 20);
    cells[i].demonstrations = static_cast<int>(i % 50);
  }
  std::vector<const Cell*> left;
  for (const Cell& cell : cells) left.push_back(&cell);
  const std::clock_t begin = std::clock();
  Schedule schedule(left);
  std::set<const Cell*> given;
  double seconds_left = schedule.left_s();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell* cell = schedule.next();
    given.insert(cell);
    if (i % 3 == 0) schedule.learn(*cell, 1 + .1 * static_cast<double>(i % 20));
    seconds_left = schedule.left_s();
  }
  EXPECT_EQ(given.size(), cells.size());
  EXPECT_NEAR(seconds_left, 0, 1e-3);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 5);
}

}  // namespace
}  // namespace lgabench
