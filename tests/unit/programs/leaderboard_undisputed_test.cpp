// Disputed truths: their files, which scenes they leave out, and success over the others.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <lgabench/abstraction/disputed.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/scenario_files.hpp>
#include <lgabench/leaderboard/pages.hpp>
#include <lgabench/leaderboard/undisputed.hpp>

#include "../../schemas.hpp"
#include "../testing.hpp"
#include "leaderboard_board.hpp"

namespace lgabench::leaderboard {
namespace {

TEST(Disputed, FilesAreAsTheirSchemaSaysAndNameWhatThereIs) {
  std::set<std::pair<std::string, std::string>> asked;  // feature space and words
  for (const auto& [id, path] : scenario_files()) {
    const Json file = read_json(path);
    for (const Json& command : file.at("commands"))
      asked.emplace(file.at("feature_space"), command.value("utterance", ""));
  }
  int commands = 0;
  for (const auto& file : fs::directory_iterator(data_directory() / "disputed")) {
    EXPECT_EQ(complaints("disputed", read_json(file.path())), std::vector<std::string>()) << file.path();
    const std::string space = file.path().stem();
    for (const auto& one : read_disputed(file.path(), load_feature_space(space))) {
      EXPECT_EQ(asked.count({space, one.first}), 1u) << one.first;
      ++commands;
    }
  }
  EXPECT_GE(commands, 15);

  const TemporaryDirectory directory;
  const fs::path file = directory.path / "tabletop.json";
  const auto read = [&](const std::string& set) {
    const std::string command = R"({"command": "Bring me the heart.", "why": "it is one", "pairs": [)" + set + "]}";
    write_file(file,
               R"({"dated": "2026-11-27", "rule": "a rule", "how": "by reading", "commands": [)" + command + "]}");
    return read_disputed(file, load_feature_space("tabletop"));
  };
  EXPECT_EQ(read(R"({"object_types": ["star"], "textures": "ALL"})").size(), 1u);
  for (const auto& [set, complaint] :
       {std::pair(R"({"object_types": ["starr"], "textures": "ALL"})", "/commands/0/pairs/0/object_types/0"),
        {R"({"object_types": "ALL", "textures": ["reddish"]})", "reddish"},
        {R"({"object_types": "ALL", "textures": "ALL", "colours": []})", "colours"},
        {"", "/commands/0/pairs: expected at least one"}})
    EXPECT_SAYS(message_of<InputError>([&, set = set] { read(set); }), complaint);
  write_file(file, R"({"dated": "", "rule": "", "how": "", "command": []})");
  EXPECT_SAYS(message_of<InputError>([&] { read_disputed(file, load_feature_space("tabletop")); }), "unknown member");
}

TEST(Disputed, ScenesAreThoseThatShowAnObjectOfAListedPair) {
  const Installed installed = installed_setting("clutter", "abstraction");
  const Scenario scenario = suite_scenario(installed.suite, "heart", Truth::released, &installed.design);
  const std::string words = scenario.command(0).utterance;
  const DisputedPairs stars{{words, {{{"star"}, scenario.space.textures}}}},
      others{{"Bring me the star.", {{scenario.space.object_types, scenario.space.textures}}}};
  int disputed = 0;
  for (int i = 0; i < 40; ++i) {
    Scene scene = test_scene(scenario, "continuous", "near_4", 5, i);
    const auto star = std::find_if(scene.objects.begin(), scene.objects.end(),
                                   [](const SceneObject& object) { return object.object_type == "star"; });
    EXPECT_EQ(is_disputed(stars, scenario, scene), star != scene.objects.end()) << i;
    EXPECT_FALSE(is_disputed(others, scenario, scene)) << "a command that is not listed has all scenes";
    if (star == scene.objects.end()) continue;
    ++disputed;
    const DisputedPairs as_it_is{{words, {{{"star"}, {star->texture}}}}}, other{{words, {{{"star"}, {"nothing"}}}}};
    EXPECT_TRUE(is_disputed(as_it_is, scenario, scene));
    EXPECT_FALSE(is_disputed(other, scenario, scene)) << "a pair is a type and a texture";
    for (SceneObject& object : scene.objects)
      if (object.object_type == "star") object.position_m = {9, 9};
    EXPECT_FALSE(is_disputed(stars, scenario, scene)) << "nobody sees it";
  }
  EXPECT_GT(disputed, 5);
  EXPECT_LT(disputed, 40);
}

TEST(Disputed, PlacesAndTheSecondRoleDoNotCount) {
  for (const auto& [suite, id, role] :
       {std::tuple("clutter", "heart", role::goal), {"fetch", "fetch_fruit", "receiver"}}) {
    const Installed installed = installed_setting(suite, "abstraction");
    const Scenario scenario = suite_scenario(installed.suite, id, Truth::released, &installed.design);
    const std::string arm = main_column(installed.setting).arm;
    const Scene scene = test_scene(scenario, installed.setting.layouts.front(), arm, 5, 0);
    for (const std::string& of : {std::string(role::target), std::string(role)}) {
      const SceneObject* object = scene.find(of);
      ASSERT_NE(object, nullptr) << of;
      const FeatureSet pair{{object->object_type}, {object->texture}};
      EXPECT_EQ(is_disputed({{scenario.command(0).utterance, {pair}}}, scenario, scene), of == role::target) << of;
    }
  }
}

// An entry in one arm, whose letters are written here.
Entry lettered(const Setting& setting, const std::vector<std::string>& letters, bool reference = false) {
  Entry entry = made_entry(setting, "a", .5, reference ? "reference" : "method");
  std::size_t i = 0;
  for (PlayedCell& cell : entry.cells)
    cell.outcomes = {{"near_4", cell.place.demonstrations == 1 ? "aaaa" : letters.at(i++)}};
  return entry;
}

TEST(Undisputed, SuccessIsTheShareOfTheOtherScenes) {
  Setting setting = small_setting();
  setting.scenarios.push_back({"ring", std::string(64, 'c'), {}});
  for (Setting::Scenario& scenario : setting.scenarios) scenario.arms = {"near_4"};
  setting.demonstrations = {1, 5};
  setting.seeds = {0, 1};
  setting.episodes = 4;
  Undisputed undisputed{{"near_4", 5}, {}, {}};
  undisputed.disputed[{"heart", "cells", 0}] = {true, false, false, false};
  undisputed.disputed[{"heart", "cells", 1}] = {true, true, true, false};
  undisputed.disputed[{"ring", "cells", 0}] = undisputed.disputed[{"ring", "cells", 1}] = {true, true, true, true};
  // heart: ".aa" and "." of scenes that count, letter ".a.." and "....", ring none.
  const std::vector<std::string> letters{"..aa", "aaa.", ".a..", "....", "....", "...."};
  EXPECT_DOUBLE_EQ(*success(undisputed, lettered(setting, letters)), (2. / 4 + 7. / 8) / 2);
  EXPECT_DOUBLE_EQ(*success(undisputed, lettered(setting, {"aaaa", "...a", "aaaa", "aaaa", "....", "...."})), 0)
      << "what is disputed does not count, nor a command all of whose scenes are";
  setting.demonstrations = {5};
  EXPECT_DOUBLE_EQ(*success(undisputed, lettered(setting, letters, true)), (2. / 4 + 7. / 8) / 2)
      << "of a reference row, which has no demonstrations";
  setting.test_scenes = TestScenes::shared;
  EXPECT_DOUBLE_EQ(*success(undisputed, lettered(setting, letters)), (2. / 6 + 7. / 8) / 2) << "one set for all seeds";
  undisputed.main.arm = "near_6";
  EXPECT_FALSE(success(undisputed, lettered(setting, letters)));
}

TEST(Undisputed, ScenesAreThoseThatEntriesPlayed) {
  const fs::path board = LGABENCH_BOARD;
  const auto directories = entry_directories(board);
  const auto published = std::find_if(directories.begin(), directories.end(),
                                      [](const fs::path& one) { return one.filename() == "clutter-abstraction"; });
  ASSERT_NE(published, directories.end());
  const Entry entry = read_entry(board, *published);
  const std::optional<Undisputed> undisputed = undisputed_of(entry.setting);
  ASSERT_TRUE(undisputed);
  EXPECT_EQ(undisputed->main.arm, "near_4");
  EXPECT_EQ(undisputed->main.demonstrations, 5);
  const std::string hole = "something_with_a_hole_in_the_middle";
  const Installed installed = installed_setting("clutter", "abstraction");
  const Scenario scenario = suite_scenario(installed.suite, hole, Truth::released, &installed.design);
  const DisputedPairs pairs = disputed_pairs(scenario.space);
  Undisputed::Scenes count;
  for (const PlayedCell& cell : entry.cells) {
    if (cell.place.scenario != hole) continue;
    std::string hashes;
    const std::vector<bool>& flags = undisputed->disputed.at({hole, cell.place.layout, cell.place.seed});
    for (const Arm& arm : scenario.tests)
      for (int i = 0; i < entry.setting.episodes; ++i) {
        const Scene scene =
            test_scene(scenario, cell.place.layout, arm.id, entry.setting.scene_seed, i, cell.place.seed);
        hashes += fmt::format("{:016x}", scene.hash());
        if (arm.id != "near_4") continue;
        ++count.all;
        count.disputed += flags.at(static_cast<std::size_t>(i));
        EXPECT_EQ(flags.at(static_cast<std::size_t>(i)), is_disputed(pairs, scenario, scene)) << i;
      }
    EXPECT_EQ(sha256(hashes), cell.scenes) << cell.place.text();
  }
  EXPECT_EQ(count.all, 3 * 50);
  EXPECT_GT(count.disputed, 0);
  EXPECT_LT(count.disputed, count.all);
  EXPECT_SAYS(words_of(*undisputed),
              fmt::format("“Bring me something with a hole in the middle.” {} of 150", count.disputed));
  EXPECT_SAYS(words_of(*undisputed), "stone.” all 150, so that the command is left out");
  EXPECT_EQ(undisputed->disputed.count({"heart", "continuous", 0}), 0u) << "nothing is disputed of it";

  Setting other = entry.setting;
  other.episodes = 49;
  EXPECT_FALSE(undisputed_of(other)) << "a preset that is not installed so";
  EXPECT_FALSE(undisputed_of(small_setting()));
}

TEST(Undisputed, StandsBesideSuccessInTheAbstractionTrack) {
  const TemporaryDirectory board;
  const Setting setting = installed_setting("clutter", "abstraction").setting;
  for (const char* id : {"gcbc_seg", "taken_features", "lga", "human"}) {
    Entry entry = made_entry(setting, id, .5);
    entry.identity.row.id = entry.identity.row.name = id;
    entry.identity.row.options = {{"policy", "heat_map"}};
    write_replayed(board.path, entry);
  }
  build(board.path);
  EXPECT_SILENT(read_file(board.path / "clutter.html"), "ndisputed") << "in no track";
  write_file(board.path / tracks_file, R"({"abstraction": {"clutter-abstraction": ["near_4"]}})");
  build(board.path);
  const std::string page = read_file(board.path / "clutter.html");
  for (const char* words : {"4 near misses, undisputed", "Undisputed: without the scenes that show an object",
                            "<th scope=col>undisputed</th>"})
    EXPECT_SAYS(page, words);
}

}  // namespace
}  // namespace lgabench::leaderboard
