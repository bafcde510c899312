// A board whose scenes come in pairs of commands: what ranks is the share of pairs that ended right twice.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include <lgabench/leaderboard/areas.hpp>
#include <lgabench/leaderboard/pages.hpp>
#include <lgabench/leaderboard/standings.hpp>
#include <lgabench/leaderboard/undisputed.hpp>
#include <lgabench/leaderboard/units.hpp>
#include <lgabench/leaderboard/verification.hpp>

#include "../../schemas.hpp"
#include "../testing.hpp"
#include "leaderboard_board.hpp"

namespace lgabench::leaderboard {
namespace {

// Scenes 2k and 2k + 1 of each scenario are a pair, or those of one number of two scenarios.
Setting setting_of(bool two_scenarios) {
  return {"errands",
          "board",
          {{"errands_fruit", std::string(64, 'a'), {"told"}, two_scenarios ? "errands_great" : "errands_fruit"},
           {"errands_great", std::string(64, 'b'), {"told"}, two_scenarios ? "errands_fruit" : "errands_great"}},
          {"continuous"},
          {5},
          {0, 1},
          8,
          TestScenes::per_seed,
          77};
}

// Every cell of a scenario has these letters.
Entry played(const Setting& setting, const std::string& name, const std::string& fruit, const std::string& great) {
  Entry entry = made_entry(setting, name, 0);
  for (PlayedCell& cell : entry.cells) cell.outcomes["told"] = cell.place.scenario == "errands_fruit" ? fruit : great;
  add_vouched(entry, replay_of(entry, name, "a processor"));
  return entry;
}

TEST(BoardPairs, AreFoundWhereScenesDifferInTheCommandAlone) {
  const Setting told = installed_setting("errands", "abstraction").setting,
                shown = installed_setting("errands", "shown").setting;
  for (const Setting::Scenario& one : told.scenarios) EXPECT_EQ(one.pair, one.id);
  for (const Setting::Scenario& one : shown.scenarios) {
    EXPECT_EQ(one.pair.substr(0, one.pair.size() - 1), one.id.substr(0, one.id.size() - 1)) << one.id;
    EXPECT_NE(one.pair, one.id);
  }
  const Setting clutter = installed_setting("clutter", "abstraction").setting;
  EXPECT_FALSE(clutter.paired());
  EXPECT_FALSE(to_json(clutter).at("scenarios").at(0).contains("pair"));
}

TEST(BoardPairs, AreReadWholeOrNotAtAll) {
  const auto complaint = [](const Setting& setting) {
    const Json json = to_json(setting);
    return message_of<InputError>([&] { read_setting(JsonReader(json, "entry.json")); });
  };
  Setting setting = setting_of(false);
  for (const Setting& one : {setting, setting_of(true)}) {
    const Json json = to_json(one);
    EXPECT_EQ(to_json(read_setting(JsonReader(json, "entry.json"))), json);
  }
  setting.scenarios[1].pair = "errands_fruit";
  EXPECT_SAYS(complaint(setting), "/scenarios/1/pair: expected a scenario with the same arms, whose \"pair\" is this");
  setting.scenarios[1].pair = "";
  EXPECT_SAYS(complaint(setting), "/scenarios/1: expected a \"pair\", as other scenarios have one");
  std::swap(setting.scenarios[0], setting.scenarios[1]);
  EXPECT_SAYS(complaint(setting), "/scenarios/1/pair: expected a scenario");
  setting = setting_of(false);
  setting.episodes = 1;
  EXPECT_SAYS(complaint(setting), "/scenarios/0/pair: expected at least 2 episodes");
}

TEST(BoardPairs, AreWonWhereBothEpisodesAre) {
  const Entry entry = played(setting_of(false), "a", "...a.aB.", "........");
  const std::vector<Standing> table = standings({&entry});
  EXPECT_DOUBLE_EQ(table[0].score, (1 / 4. + 1) / 2);
  EXPECT_DOUBLE_EQ(table[0].at.at(5), table[0].score);
  EXPECT_DOUBLE_EQ(table[0].in_arm.at("told"), table[0].score);
  EXPECT_DOUBLE_EQ(table[0].in_scenario.at("errands_fruit"), 1 / 4.);
  EXPECT_DOUBLE_EQ(control_success(entry), table[0].score);
  ASSERT_TRUE(table[0].each);
  EXPECT_DOUBLE_EQ(table[0].each->score, (5 / 8. + 1) / 2);
  EXPECT_EQ(table[0].episodes, 32);
  const Rates rates = rates_of(entry);
  ASSERT_EQ(rates.size(), 2u);
  EXPECT_EQ(rates[0], (std::vector<std::vector<double>>(2, {1, 0, 0, 0})));
  EXPECT_EQ(Units(entry).cells().front().outcomes.at("told"), ".aaB") << "the first failure is the pair's";
}

TEST(BoardPairs, OfTwoScenariosAreOneUnit) {
  Entry entry = played(setting_of(true), "a", "......aa", "..aa....");
  entry.cells.back().failed = "signal 11";
  for (auto& arm : entry.cells.back().outcomes) arm.second = std::string(8, failed_cell_letter);
  const std::vector<Standing> table = standings({&entry});
  EXPECT_DOUBLE_EQ(table[0].score, (4 / 8. + 0) / 2) << "the second policy's other cell is lost, and so its pairs";
  EXPECT_EQ(table[0].in_scenario.count("errands_great"), 0u);
  EXPECT_EQ(rates_of(entry).size(), 1u);
  EXPECT_EQ(rates_of(entry)[0][0], (std::vector<double>{1, 1, 0, 0, 1, 1, 0, 0}));
  EXPECT_EQ(table[0].failed_cells, 1);
}

TEST(BoardPairs, RankRowsThatSucceedEquallyOften) {
  Setting setting = setting_of(false);
  setting.episodes = 40;
  std::string both, one;
  for (int i = 0; i < 10; ++i) {
    both += "..aa";
    one += ".a.a";
  }
  const Entry hears = played(setting, "hears", both, both), deaf = played(setting, "deaf", one, one);
  const std::vector<Standing> table = standings({&deaf, &hears});
  EXPECT_EQ(table[0].entry, &hears);
  EXPECT_EQ(table[0].rank, 1);
  EXPECT_EQ(table[1].rank, 2);
  EXPECT_DOUBLE_EQ(table[1].score, 0);
  EXPECT_DOUBLE_EQ(table[1].each->score, table[0].each->score);
  EXPECT_LT(table[1].interval.high, table[0].interval.low);
}

TEST(BoardPairs, WithADisputedSceneAreLeftOut) {
  const Entry entry = played(setting_of(false), "a", "..aa...a", "........");
  Undisputed undisputed{{"told", 5}, {}, {}};
  for (const std::uint64_t set : {0, 1})
    undisputed.disputed[{"errands_fruit", "continuous", set}] = {false, true, false, false, false, false, false, false};
  EXPECT_DOUBLE_EQ(*success(undisputed, entry), (1 / 3. + 1) / 2);
}

TEST(BoardPairs, AreCountedOnFreshScenes) {
  for (const bool two_scenarios : {false, true}) {
    const Entry entry = played(setting_of(two_scenarios), "a", "....aaaa", ".......a");
    Json line = replay_of(entry, "a", "a processor");
    line.update({{"kind", "fresh"}, {"flips", 0}, {"bit_identical", 0}, {"cells", Json::array()}});
    line.erase("only_recorded");
    int episodes = 0;
    for (const std::size_t i : fresh_cells(entry, line.at("nonce"))) {
      line["cells"].push_back(entry.cells[i].key);
      episodes += entry.cells[i].episodes();
    }
    line["episodes"] = episodes;
    line["successes"] = two_scenarios ? Json::array({{{"told", 4}}}) : Json::array({{{"told", 2}}, {{"told", 3}}});
    const std::vector<FreshEstimate> estimates = fresh_estimates(entry, {&line});
    ASSERT_EQ(estimates.size(), 1u);
    EXPECT_DOUBLE_EQ(estimates[0].difference, 0);
    const double share = two_scenarios ? 5 / 10. : 3 / 6., other = 4 / 6.;  // a success and a failure more
    const double variance =
        two_scenarios ? share * (1 - share) / 10 : (share * (1 - share) + other * (1 - other)) / 6 / 4;
    EXPECT_NEAR(estimates[0].high, statistics::z_95 * std::sqrt(2 * variance), 1e-9) << "of pairs, not of episodes";
    line.update({{"passed", true}, {"difference", 0}, {"low", estimates[0].low}, {"high", estimates[0].high}});
    const auto read = [&] { expect_verification(JsonReader(line, "verifications.jsonl"), entry, entry.hash()); };
    EXPECT_NO_THROW(read());
    line["successes"][0]["told"] = two_scenarios ? 9 : 5;
    EXPECT_SAYS(message_of<InputError>(read), "/successes/0/told: expected");
    line["successes"].push_back({{"told", 1}});
    EXPECT_SAYS(message_of<InputError>(read), "/successes: expected an object for each cell");
  }
}

TEST(BoardPairs, AreWhatPagesSay) {
  const TemporaryDirectory board;
  for (const bool paired : {false, true}) {
    const Entry entry =
        paired ? played(setting_of(false), "a", "...a.aB.", "........") : made_entry(small_setting(), "b", .5);
    write_replayed(board.path, entry);
    EXPECT_EQ(complaints("entry", read_json(board.path / entry.place() / "entry.json")), std::vector<std::string>());
    build(board.path);
    const std::string csv = read_file(board.path / "leaderboard.csv"), readme = read_file(board.path / "README.md");
    EXPECT_EQ(csv.find("paired") != csv.npos, paired);
    EXPECT_EQ(readme.find("aired success") != readme.npos, paired);
  }
  const std::string csv = read_file(board.path / "leaderboard.csv"), page = read_file(board.path / "errands.html"),
                    other = read_file(board.path / "q1.html"), readme = read_file(board.path / "README.md");
  EXPECT_SAYS(csv, ",not_ranked,by,paired_share,paired_low,paired_high\n");
  EXPECT_SAYS(csv, ",any policy,1,0.8125,,,32,0,");
  EXPECT_SAYS(csv, ",a,0.625,0.");
  EXPECT_SAYS(csv, ",5,any policy,,0.8125,,,,,,,,,,,,,0.625,,\n");
  EXPECT_SAYS(csv, ",b,,,\n");
  EXPECT_SAYS(page, "Paired success: both commands of a pair right on one scene.");
  EXPECT_SAYS(page, "Paired success is the mean over scenarios of the share of scenes in which both commands");
  EXPECT_SAYS(page, ">success per episode<");
  EXPECT_SAYS(page, "Paired success in each scenario");
  EXPECT_SAYS(readme, "| rank | method | policy | paired success |");
  EXPECT_SAYS(readme, "Paired success: both commands of a pair right on one scene.");
  EXPECT_EQ(other.find("aired success"), other.npos);
  EXPECT_SAYS(other, "Success is the mean over scenarios of the share of successful episodes");
}

}  // namespace
}  // namespace lgabench::leaderboard
