// Entries of a leaderboard: what is written is read again, what was changed is found.
#include <gtest/gtest.h>

#include <algorithm>

#include <utility>

#include <cmath>
#include <ctime>
#include <functional>

#include <lgabench/leaderboard/areas.hpp>
#include <lgabench/leaderboard/check.hpp>
#include <lgabench/leaderboard/fresh_commands.hpp>
#include <lgabench/leaderboard/pages.hpp>
#include <lgabench/leaderboard/played_cell.hpp>
#include <lgabench/leaderboard/standings.hpp>
#include <lgabench/leaderboard/suite_page.hpp>
#include <lgabench/leaderboard/verification.hpp>
#include <lgabench/statistics/bootstrap.hpp>

#include "../../schemas.hpp"
#include "../testing.hpp"
#include "leaderboard_board.hpp"

namespace lgabench::leaderboard {
namespace {

TEST(LeaderboardEntry, IsReadAsItWasWrittenAndIsAsItsSchemasSay) {
  const TemporaryDirectory board;
  Entry entry = made_entry(small_setting(), "a", .5);
  entry.cells[2].failed = "signal 11";
  entry.cells[2].scenes = entry.cells[2].digest = "";
  for (auto& arm : entry.cells[2].outcomes) arm.second = std::string(40, failed_cell_letter);
  write_entry(board.path, entry);
  add_verification(board.path, entry, replay_of(entry, "somebody", "another"));
  EXPECT_EQ(read_entries(board.path).front().tier(), Tier::recomputed) << "a claim";
  vouch(board.path, entry.id(), "1");
  const Entry read = read_entries(board.path).front();
  EXPECT_EQ(entry_text(read), entry_text(entry));
  EXPECT_EQ(cells_text(read), cells_text(entry));
  EXPECT_EQ(read.tier(), Tier::reproduced);
  EXPECT_EQ(read.place(), fs::path("entries/method_of_a") / entry.id() / "q1-board");
  const fs::path path = board.path / entry.place();
  using Complaints = std::vector<std::string>;
  EXPECT_EQ(complaints("entry", read_json(path / "entry.json")), Complaints());
  EXPECT_EQ(complaints("entry_meta", entry.about), Complaints());
  for (const Json& line : documents(path / "cells.jsonl")) EXPECT_EQ(complaints("cells", line), Complaints());
  for (const Json& line : documents(path / "verifications.jsonl"))
    EXPECT_EQ(complaints("verifications", line), Complaints());
  Json vouched = read_json(board.path / "vouched_entries.json");
  EXPECT_EQ(complaints("vouched_entries", vouched), Complaints());
  vouched[entry.hash()] = 1;
  EXPECT_NE(complaints("vouched_entries", vouched), Complaints());
}

TEST(LeaderboardEntry, NoLineCountsOnceTheEntrySaysSomethingElse) {
  const TemporaryDirectory board;
  Entry entry = made_entry(small_setting(), "a", .5);
  write_replayed(board.path, entry);
  const auto is_replayed = [&] { return read_entries(board.path).front().was_replayed(); };
  entry.evidence.push_back(entry.evidence.front());
  entry.withdrawn = {{"when", "2026-01-01"}, {"reason", "a mistake"}};
  write_entry(board.path, entry);
  EXPECT_TRUE(is_replayed()) << "evidence and a claimed withdrawal may come";
  const Json about = std::exchange(entry.about["by"], "somebody else");
  write_entry(board.path, entry);
  EXPECT_FALSE(is_replayed());
  EXPECT_SAYS(message_of<InputError>([&] { vouch(board.path, entry.id(), "withdrawn"); }),
              "entry.json is not the one that vouched_entries.json has the hash of");
  entry.about["by"] = about;
  write_entry(board.path, entry);
  EXPECT_TRUE(is_replayed());
  fs::remove(board.path / "vouched_entries.json");
  EXPECT_FALSE(is_replayed());
  vouch(board.path, entry.id(), "1");  // which was vouched for before there was the file
  EXPECT_TRUE(is_replayed());
  EXPECT_SAYS(message_of<InputError>([&] { vouch(board.path, entry.id(), "1"); }), "line 1 is vouched for already");
}

TEST(LeaderboardEntry, AVersionOrASceneSeedIsAnotherEntryAndABuildIsNot) {
  const Entry entry = made_entry(small_setting(), "a", .5);
  Entry other = entry;
  other.evidence.front()["build"] = {{"lgabench-worker", std::string(64, 'f')}};
  EXPECT_EQ(other.id(), entry.id());
  other.identity.row.version = "1.1";
  EXPECT_NE(other.id(), entry.id());
  Setting seed = small_setting();
  ++seed.scene_seed;
  EXPECT_NE(made_entry(seed, "a", .5).id(), entry.id());
  EXPECT_EQ(hash(seed), hash(small_setting()));
}

// What somebody could change in the files, and what is said of it.
TEST(LeaderboardEntry, WhatWasChangedIsFound) {
  const auto after = [](const std::function<void(const fs::path&)>& change) {
    const TemporaryDirectory board;
    const Entry entry = made_entry(small_setting(), "a", .5);
    write_entry(board.path, entry);
    change(board.path / entry.place());
    return message_of<InputError>([&] { read_entry(board.path, entry.place()); });
  };
  const auto edit = [](const fs::path& file, const std::string& from, const std::string& to) {
    std::string text = read_file(file);
    ASSERT_NE(text.find(from), std::string::npos) << from;
    write_file(file, text.replace(text.find(from), from.size(), to));
  };
  const auto json = [](const fs::path& path, const std::function<void(Json&)>& change) {
    Json entry = read_json(path / "entry.json");
    change(entry);
    write_file(path / "entry.json", entry.dump(1) + "\n");
  };
  EXPECT_SAYS(after([&](auto& path) { edit(path / "cells.jsonl", "\"test\":\"", "\"test\":\"."); }),
              "expected 40 letters, one an episode");
  EXPECT_SAYS(after([&](auto& path) { edit(path / "cells.jsonl", "a", "z"); }), "expected");
  EXPECT_SAYS(after([&](auto& path) {
                const std::string text = read_file(path / "cells.jsonl");
                write_file(path / "cells.jsonl", text.substr(text.find('\n') + 1));
              }),
              "expected the cell heart cells n=10 seed=0");
  EXPECT_SAYS(after([&](auto& path) {
                const std::string text = read_file(path / "cells.jsonl");
                write_file(path / "cells.jsonl", text.substr(0, text.rfind('\n', text.size() - 2) + 1));
              }),
              "expected 12 cells, got 11; the next is letter cells n=20 seed=2");
  EXPECT_SAYS(after([&](auto& path) { json(path, [](Json& e) { e["identity"]["version"] = "2.0"; }); }),
              "the hash of /identity");
  EXPECT_SAYS(after([&](auto& path) { json(path, [](Json& e) { e["preset"]["episodes"] = 20; }); }),
              "the hash of /preset");
  const auto preset = [&](const char* member, const Json& value) {
    return after([&](auto& path) { json(path, [&](Json& e) { e["preset"][member] = value; }); });
  };
  EXPECT_SAYS(preset("episodes", 1000000), "/preset/episodes: expected a whole number from 1 to 10000");
  EXPECT_SAYS(preset("seeds", std::vector<int>(9000)), "/preset: expected at most 10000 cells");
  EXPECT_SAYS(preset("layouts", {"$(x)"}), "/preset/layouts/0: expected letters, digits and _");
  EXPECT_SAYS(after([&](auto& path) { json(path, [](Json& e) { e["identity"]["engine"]["id"] = "a; touch b"; }); }),
              "/identity/engine/id: expected an id");
  EXPECT_SAYS(after([&](auto& path) {
                json(path, [](Json& e) { e["said"][e["said"].size() - 2]["target"]["textures"]["precision"] = 1e300; });
              }),
              "/precision: expected a number from 0 to 1");
  EXPECT_SAYS(after([&](auto& path) { edit(path / "cells.jsonl", "\"lm_queries\":112.0", "\"lm_queries\":1e+300"); }),
              "/lm_queries: expected a number from 0 to 1e+15");
  EXPECT_SAYS(after([&](auto& path) { write_file(path / "cells.jsonl", std::string((16 << 20) + 1, ' ')); }),
              "cells.jsonl: cannot be read: 16777217 bytes or more, expected at most 16777216");
  EXPECT_SAYS(after([&](auto& path) { fs::remove(path / "cells.jsonl"); }),
              "cells.jsonl: cannot be read: No such file");
  EXPECT_SAYS(after([&](auto& path) { json(path, [](Json& e) { e["success"] = .99; }); }), "success");
  EXPECT_SAYS(after([&](auto& path) { json(path, [](Json& e) { e["about"].erase("license"); }); }), "license");
  EXPECT_SAYS(after([&](auto& path) { json(path, [](Json& e) { e["evidence"][0]["started"] = "yesterday"; }); }),
              "/evidence/0/started: expected a time");
  EXPECT_SAYS(after([&](auto& path) { write_file(path / "note.txt", ""); }), "expected only entry.json, cells.jsonl");
  EXPECT_SAYS(after([&](auto& path) { edit(path / "entry.json", "\n", "\n\n"); }), "not as it is written");
}

TEST(LeaderboardEntry, AVerificationPlaysTheCellsThatItsNonceChooses) {
  const TemporaryDirectory board;
  const Entry entry = made_entry(small_setting(), "a", .5);
  write_entry(board.path, entry);
  Json forged = replay_of(entry, "b", "another");
  std::swap(forged["cells"][0], forged["cells"][1]);
  add_verification(board.path, entry, forged);
  EXPECT_SAYS(message_of<InputError>([&] { read_entry(board.path, entry.place()); }),
              "the cells that the nonce chooses");
}

TEST(LeaderboardEntry, AVerificationOfNoCellIsNone) {
  const TemporaryDirectory board;
  const Entry entry = made_entry(small_setting(), "a", .5);
  write_entry(board.path, entry);
  Json empty = replay_of(entry, "b", "another");
  empty["cells"] = Json::array();
  empty["bit_identical"] = empty["episodes"] = 0;
  add_verification(board.path, entry, empty);
  EXPECT_SAYS(message_of<InputError>([&] { read_entry(board.path, entry.place()); }),
              "/cells: expected at least one cell");
}

TEST(LeaderboardEntry, TiersFollowFromLinesThatSomebodyVouchesFor) {
  Entry entry = made_entry(small_setting(), "a", .5);
  EXPECT_EQ(why_not_ranked(entry), "not yet replayed");
  entry.verifications.push_back(replay_of(entry, "a", "another"));
  EXPECT_EQ(entry.tier(), Tier::recomputed);
  EXPECT_EQ(why_not_ranked(entry), "not yet replayed");
  add_vouched(entry, replay_of(entry, "a", "another"));  // by the same person
  EXPECT_EQ(entry.tier(), Tier::replayed);
  EXPECT_EQ(why_not_ranked(entry), "");
  add_vouched(entry, replay_of(entry, "b", "another"));
  EXPECT_EQ(entry.tier(), Tier::reproduced);
  entry.verifications.push_back(replay_of(entry, "c", "third", false));
  EXPECT_EQ(why_not_ranked(entry), "") << "a claim";
  EXPECT_EQ(claims(entry), std::vector<std::string>{"claimed by c: a replay differed"});
  entry.vouched.insert(line_hash(entry.verifications.back()));
  EXPECT_EQ(entry.tier(), Tier::recomputed);
  EXPECT_EQ(why_not_ranked(entry), "a replay differed");
}

TEST(LeaderboardEntry, MoreFailuresThanLettersAreRefusedBeforeAnythingIsWritten) {
  Entry entry;
  statistics::CellResult result;
  result.failed = true;
  for (int i = 0; i < 26; ++i) entry.failures.push_back(fmt::format("failure_{}", i));
  played_cell(result, "", "", entry);
  entry.failures.emplace_back("another");
  EXPECT_SAYS(message_of<InputError>([&] { played_cell(result, "", "", entry); }), "27 words for failures");
}

TEST(LeaderboardEntry, ArmsOfAmbiguousWordsAreNoPartOfIt) {
  const Setting setting = installed_setting("paraphrases", "leaderboard").setting;
  const std::vector<std::string> all{"original", "synonym", "polite", "described", "implied"};
  EXPECT_EQ(setting.scenario("paraphrase_heart").arms, all);
  EXPECT_EQ(setting.scenario("paraphrase_red_heart").arms, std::vector<std::string>(all.begin(), all.end() - 1));
  Entry entry;
  statistics::CellResult result;
  result.failed = true;
  result.episodes_per_arm = 2;
  result.arms = {"original", "implied"};
  result.ambiguous = {"implied"};
  EXPECT_EQ(played_cell(result, "", "", entry).outcomes.size(), 1u);
}

// "" where it is read.
std::string complaint_of(const fs::path& board, const Entry& entry, const Vouched& vouched = {}) {
  try {
    read_entry(board, entry.place(), &vouched);
    return "";
  } catch (const InputError& e) {
    return e.what();
  }
}

TEST(LeaderboardEntry, AReplayOwesTheSameBitsOnOneKindOfProcessor) {
  const TemporaryDirectory board;
  Entry entry = made_entry(small_setting(), "a", .5);
  const auto complaint = [&](const Json& machine, const Json& changed = Json::object()) {
    Json line = replay_of(entry, "b", "a processor");
    line.update({{"machine", machine}, {"bit_identical", 0}});
    line.update(changed);
    EXPECT_EQ(complaints("verifications", line), std::vector<std::string>());
    write_file(board.path / entry.place() / "verifications.jsonl", canonical(line) + "\n");
    const Vouched vouched = read_vouched(board.path);
    return complaint_of(board.path, entry, vouched);
  };
  const Json same{{"processor", "a processor"}, {"instructions", "AVX2"}}, unknown{{"processor", "a processor"}};
  const std::string owed = "/passed: expected false, by its counts";
  write_entry(board.path, entry);
  EXPECT_SAYS(complaint(same), owed);
  EXPECT_SAYS(complaint({{"processor", "a processor with AVX2"}}), owed);
  for (const Json& other : {unknown,
                            Json{{"processor", "a processor"}, {"instructions", "AVX-512"}},
                            {{"processor", "another"}, {"instructions", "AVX2"}}})
    EXPECT_EQ(complaint(other), "") << other << ": whether the method owes the same bits, its line alone does not say";
  entry.evidence.front()["machine"] = unknown;
  write_entry(board.path, entry);
  EXPECT_EQ(complaint(same), "") << "the entry does not say";
  EXPECT_EQ(complaint(unknown), "");
  write_file(board.path / instructions_file, Json{{entry.id(), "AVX2"}}.dump());
  EXPECT_SAYS(complaint(same), owed);
  EXPECT_EQ(complaint(unknown), "");
  const Entry inferred = read_entries(board.path).front();
  EXPECT_EQ(to_string(inferred.processor()), "a processor with AVX2 (inferred)");
  EXPECT_EQ(inferred.rest_hash(), entry.rest_hash()) << "what maintainers infer changes no entry";
}

// What honest replays of few cells found, whose episodes turn together: DIFFERS by the rule before, in none by chance.
TEST(LeaderboardEntry, AFewCellsOnAProcessorThatOwesNoBitsAgree) {
  const TemporaryDirectory board;
  Entry entry = made_entry(small_setting(), "a", .5);  // 12 cells, half of them with 40 episodes, half with 80
  entry.evidence.front()["machine"] = {{"processor", "a processor"}};
  write_entry(board.path, entry);
  const auto complaint = [&](const Json& counts) {
    Json line = replay_of(entry, "b", "a processor");
    line.update({{"bit_identical", 0}});
    line.update(counts);
    EXPECT_EQ(complaints("verifications", line), std::vector<std::string>());
    write_file(board.path / entry.place() / "verifications.jsonl", canonical(line) + "\n");
    return complaint_of(board.path, entry);
  };
  const std::string differs = "/passed: expected false, by its counts";
  EXPECT_EQ(complaint({{"flips", 10}, {"only_recorded", 6}, {"worse", 3}, {"better", 2}}), "") << "ten of 720";
  EXPECT_SAYS(complaint({{"flips", 11}, {"only_recorded", 6}, {"worse", 3}, {"better", 2}}), differs);
  EXPECT_EQ(complaint({{"flips", 7}, {"only_recorded", 7}, {"worse", 5}, {"better", 0}}), "");
  EXPECT_SAYS(complaint({{"flips", 7}, {"only_recorded", 7}, {"worse", 6}, {"better", 0}}), differs);
  EXPECT_SAYS(complaint({{"flips", 7}, {"only_recorded", 7}}), differs) << "a line that does not say in which cells";
  EXPECT_SAYS(complaint({{"flips", 2}, {"only_recorded", 1}, {"worse", 2}, {"better", 0}}), "/worse: expected a whole");
  EXPECT_SAYS(complaint({{"flips", 2}, {"only_recorded", 1}, {"worse", 1}, {"better", 2}}),
              "/better: expected a whole");
  EXPECT_SAYS(complaint({{"flips", 2}, {"only_recorded", 1}, {"worse", 1}}), "better");
}

// A line of fresh scenes: in each arm so many successes more than on the board's.
Json fresh_of(const Entry& entry, const std::map<std::string, int>& more, char nonce = '7') {
  Json line = replay_of(entry, "b", "another");
  line.update({{"kind", "fresh"},
               {"nonce", std::string(32, nonce)},
               {"bit_identical", 0},
               {"cells", Json::array()},
               {"successes", Json::array()}});
  line.erase("only_recorded");
  int episodes = 0;
  for (const std::size_t i : fresh_cells(entry, line.at("nonce"))) {
    const PlayedCell& cell = entry.cells[i];
    line["cells"].push_back(cell.key);
    Json& successes = line["successes"].emplace_back();
    for (const auto& [arm, letters] : cell.outcomes) {
      const int before = lgabench::successes(letters);
      successes[arm] = std::clamp(before + (more.count(arm) ? more.at(arm) : 0), 0, entry.setting.episodes);
    }
    episodes += cell.episodes();
  }
  line["episodes"] = episodes;
  const std::vector<FreshEstimate> estimates = fresh_estimates(entry, {&line});
  line["passed"] = std::none_of(estimates.begin(), estimates.end(), [](const auto& one) { return one.differs(); });
  line["difference"] = estimates.back().difference;
  line["low"] = estimates.back().low;
  line["high"] = estimates.back().high;
  return line;
}

TEST(LeaderboardEntry, EveryArmIsLookedAtOnFreshScenes) {
  const Entry entry = made_entry(small_setting(), "a", .5);
  const auto estimates = [&](const std::map<std::string, int>& more) {
    const Json line = fresh_of(entry, more);
    return fresh_estimates(entry, {&line});
  };
  const std::vector<FreshEstimate> memorised = estimates({{"hard", -14}});
  ASSERT_EQ(memorised.size(), 3u);
  EXPECT_EQ(memorised[0].arm, "hard");
  EXPECT_NEAR(memorised[0].difference, -14 / 40., 1e-12);
  EXPECT_TRUE(memorised[0].differs());
  EXPECT_FALSE(memorised[1].differs()) << memorised[1].arm;
  EXPECT_EQ(memorised[2].arm, "") << "the mean over arms";
  EXPECT_NEAR(memorised[2].difference, -14 / 40. / 4, 1e-12) << "one of two arms in one of two scenarios";
  for (const FreshEstimate& one : estimates({})) EXPECT_FALSE(one.differs());
}

TEST(LeaderboardEntry, FreshScenesArePooled) {
  Entry entry = replayed_entry(small_setting(), "a", .5);
  EXPECT_EQ(entry.fresh(), 0);
  const Json failed = fresh_of(entry, {{"test", -18}});
  add_vouched(entry, failed);
  EXPECT_EQ(why_not_ranked(entry), "differs on fresh scenes");
  for (int i = 0; i < 3; ++i) add_vouched(entry, failed);
  EXPECT_EQ(entry.fresh(), -1) << "what is found again is no chance";
  // Thirty lines of somebody who does not count bury nothing.
  Json harmless = fresh_of(entry, {});
  for (int i = 0; i < 30; ++i) {
    harmless["by"] = fmt::format("a friend {}", i);
    entry.verifications.push_back(harmless);
  }
  EXPECT_EQ(why_not_ranked(entry), "differs on fresh scenes");

  Entry lucky = replayed_entry(small_setting(), "a", .5);
  add_vouched(lucky, fresh_of(lucky, {{"test", 10}}));
  EXPECT_EQ(lucky.fresh(), -1);
  for (int i = 0; i < 9; ++i) add_vouched(lucky, fresh_of(lucky, {}));
  EXPECT_EQ(why_not_ranked(lucky), "") << "one line in ten, by chance";
}

// A line of drawn commands: so many of them exact, and of the published ones.
Json commands_of(const Entry& entry, int exact, int of, int published_exact, int published) {
  Json line = replay_of(entry, "b", "another");
  for (const char* other : {"cells", "bit_identical", "flips", "only_recorded", "episodes"}) line.erase(other);
  line.update({{"kind", "commands"},
               {"commands", of},
               {"exact", exact},
               {"lga_exact", of},
               {"published", published},
               {"published_exact", published_exact}});
  line["passed"] = knows_fresh_commands({&line});
  return line;
}

TEST(LeaderboardEntry, ATableOfPublishedTruthsIsNoMethodForDrawnCommands) {
  Entry entry = replayed_entry(small_setting(), "a", .5);
  const auto passes = [&](int exact, int published_exact, int published = 14, int of = 40) {
    return commands_of(entry, exact, of, published_exact, published).at("passed").get<bool>();
  };
  EXPECT_FALSE(passes(0, 14)) << "a table";
  EXPECT_FALSE(passes(0, 2, 2)) << "a table of two commands";
  EXPECT_FALSE(passes(20, 14));
  EXPECT_TRUE(passes(38, 14)) << "five points less than lga";
  EXPECT_TRUE(passes(37, 14)) << "by chance";
  EXPECT_TRUE(passes(12, 5)) << "an ablation that is as good as it was";
  EXPECT_TRUE(passes(0, 0)) << "nothing was known by heart";
  EXPECT_EQ(entry.fresh_commands(), 0);
  entry.verifications.push_back(commands_of(entry, 0, 40, 14, 14));
  EXPECT_EQ(why_not_ranked(entry), "") << "a claim";
  add_vouched(entry, commands_of(entry, 0, 40, 14, 14));
  EXPECT_EQ(why_not_ranked(entry), "differs on fresh commands");
  Entry pooled = replayed_entry(small_setting(), "a", .5);
  add_vouched(pooled, commands_of(pooled, 36, 40, 14, 14));
  EXPECT_EQ(pooled.fresh_commands(), 1);
  for (int i = 0; i < 9; ++i) add_vouched(pooled, commands_of(pooled, 36, 40, 14, 14));
  EXPECT_EQ(pooled.fresh_commands(), 1) << "Fisher's test of 360 of 400 beside 14 of 14";
  const auto complaint = [&](Json line, const char* member, const Json& value) {
    line[member] = value;
    return message_of<InputError>(
        [&] { expect_verification(JsonReader(line, "verifications.jsonl"), entry, entry.hash()); });
  };
  const Json line = commands_of(entry, 0, 40, 14, 14);
  EXPECT_SAYS(complaint(line, "passed", true), "/passed: expected false, by its counts");
  EXPECT_SAYS(complaint(line, "exact", 41), "/exact: expected");
  EXPECT_SAYS(complaint(line, "commands", 19), "/commands: expected");
  EXPECT_SAYS(complaint(line, "commands", most_commands + 1), "/commands: expected");
  EXPECT_SAYS(complaint(line, "published", most_published + 1), "/published: expected");
}

TEST(LeaderboardEntry, WhatFreshScenesFindIsSaid) {
  const Entry entry = made_entry(small_setting(), "a", .5);
  const Json line = fresh_of(entry, {});
  const std::vector<FreshEstimate> estimates = fresh_estimates(entry, {&line});
  const double error = (estimates.back().high - estimates.back().low) / 2 / 1.959964;
  EXPECT_NEAR(smallest_found(estimates), error * (2.393980 + 0.841621), 1e-5) << "Holm's first of three";
}

TEST(LeaderboardEntry, OtherPersonsDifferMoreThanOtherScenesOfTheSame) {
  Entry entry = made_entry(small_setting(), "a", .5);
  for (PlayedCell& cell : entry.cells)
    for (auto& arm : cell.outcomes)
      for (std::size_t i = 0; i < arm.second.size(); ++i) arm.second[i] = i % 4 < 2 ? '.' : 'a';
  Json line = fresh_of(entry, {});
  const double scenes = fresh_estimates(entry, {&line}).back().high;
  line["persons"] = 4;  // two always win, two always lose: their mean has the variance 1/3 / 4
  const double persons = fresh_estimates(entry, {&line}).back().high;
  EXPECT_NEAR(persons / scenes, std::sqrt((1. / 3 / 4) / (.25 / 42)), .05);
  line["persons"] = 40;  // of a scene each
  EXPECT_NEAR(fresh_estimates(entry, {&line}).back().high / scenes, 1, .05);
}

TEST(LeaderboardEntry, AFreshLineIsWhatItsSuccessesSay) {
  const TemporaryDirectory board;
  const Entry entry = made_entry(small_setting(), "a", .5);
  const auto complaint = [&](const std::function<void(Json&)>& change) {
    write_entry(board.path, entry);
    Json line = fresh_of(entry, {{"hard", -14}});
    change(line);
    write_file(board.path / entry.place() / "verifications.jsonl", canonical(line) + "\n");
    return message_of<InputError>([&] { read_entry(board.path, entry.place()); });
  };
  write_entry(board.path, entry);
  add_verification(board.path, entry, fresh_of(entry, {}));
  EXPECT_EQ(read_entry(board.path, entry.place()).verifications.size(), 1u);
  EXPECT_EQ(complaints("verifications", fresh_of(entry, {})), std::vector<std::string>());
  EXPECT_SAYS(complaint([](Json& line) { line["passed"] = true; }), "/passed: expected false, by its successes");
  EXPECT_SAYS(complaint([](Json& line) { line["difference"] = 0; }), "/difference: expected -0.0875");
  EXPECT_SAYS(complaint([](Json& line) { line["successes"][0]["test"] = 41; }), "/test: expected a whole number");
  EXPECT_SAYS(complaint([](Json& line) { line["successes"][0].erase("test"); }), "test");
  EXPECT_SAYS(complaint([](Json& line) { line["cells"][0] = line["cells"][1]; }), "the cells that the nonce chooses");
  EXPECT_SAYS(complaint([](Json& line) { line["low"] = -1e300; }), "/low: expected a difference of two rates");
  Json old = fresh_of(entry, {});
  old.erase("successes");
  write_file(board.path / entry.place() / "verifications.jsonl", canonical(old) + "\n");
  EXPECT_SAYS(message_of<InputError>([&] { vouch(board.path, entry.id(), "1"); }), "looked at one arm alone");
}

// A Selection of a shape that no program writes: whole numbers where names stand, lists of both, an empty list.
Entry oddly_selecting_entry() {
  Entry entry = made_entry(small_setting(), "a", .5);
  Json other = entry.phi["heart"][0][0];
  other["selection"].update(Json::parse(
      R"({"cost": {"lm_queries": 3, "lm_seconds": 0.5}, "avoid": {"sets": [{"textures": ["red", "blue"]}], "odd": [1, ["red", "blue"], 7]}})"));
  entry.phi["heart"].push_back(Json::array({other, entry.phi["heart"][0][0], other}));
  entry.phi["letter"] = Json::array({Json::array({other}), Json::array()});
  return entry;
}

TEST(LeaderboardEntry, SaysEachSelectionOnceAndIsReadInItsLongFormToo) {
  const TemporaryDirectory board;
  const Entry entry = oddly_selecting_entry();
  write_replayed(board.path, entry);
  const fs::path file = board.path / entry.place() / "entry.json";
  const Json json = read_json(file);
  EXPECT_EQ(complaints("entry", json), std::vector<std::string>());
  EXPECT_EQ(json.at("phi"), Json::parse(R"({"heart": [[3], [8, 3, 8]], "letter": [[8], []]})")) << json.dump(1);
  for (const std::string& form : {entry_text(entry), long_entry_text(entry)}) {
    write_file(file, form);
    const Entry read = read_entries(board.path).front();
    EXPECT_EQ(read.phi, entry.phi);
    EXPECT_EQ(read.rest_hash(), entry.rest_hash());
    EXPECT_TRUE(read.was_replayed()) << "vouched for in either form";
  }
  EXPECT_EQ(complaints("entry", read_json(file)), std::vector<std::string>());
  EXPECT_LT(entry_text(entry).size(), long_entry_text(entry).size());
  EXPECT_EQ(build(board.path).size(), 5u) << "the board's four files, and the entry in its short form";
  EXPECT_EQ(read_file(file), entry_text(entry));
  // Whole numbers of the short form that stand for nothing, or for too much.
  const auto complaint = [&](const std::string& from, const std::string& to) {
    std::string text = entry_text(entry);
    text.replace(text.find(from), from.size(), to);
    write_file(file, text);
    return message_of<InputError>([&] { read_entry(board.path, entry.place()); });
  };
  EXPECT_SAYS(complaint("    8,", "    99,"), "expected a whole number from 0 to 8, got 99");
  EXPECT_SAYS(complaint("    8,", "    -1,"), "expected a whole number from 0 to 8, got -1");
  EXPECT_SAYS(complaint("    8,", "    2,"), "/phi/heart/1/0: expected a member \"utterance\"");  // a quality
  EXPECT_SAYS(complaint("    8,", "    8.0,"), "expected an object");
  EXPECT_SAYS(complaint("\n ]\n}", ",\n  []\n ]\n}"), "not as it is written");
  EXPECT_SAYS(complaint(" \"said\": [", " \"said\": 1, \"no\": ["), "/said: expected an array");
  Json large = json;
  large["said"][0] = std::string(1 << 20, 'x');
  large["said"][1] = Json::parse(R"({"provenance": "rule", "target": [0, 0, 0, 0, 0, 0, 0, 0, 0]})");
  large["said"][2] = Json::parse(R"({"utterance": "a", "selection": 1, "quality": null})");
  large["phi"]["heart"] = Json::array({std::vector<int>(3, 2)});
  write_file(file, large.dump(1) + "\n");
  EXPECT_SAYS(message_of<InputError>([&] { read_entry(board.path, entry.place()); }),
              "/said: expected values of at most 25165824 bytes");
}

TEST(LeaderboardEntry, LinesThatNobodyVouchesForAreFewAndCheap) {
  const TemporaryDirectory board;
  const Entry entry = made_entry(large_setting(), "a", .5);
  write_replayed(board.path, entry);
  const fs::path file = board.path / entry.place() / "verifications.jsonl";
  const std::string own = read_file(file);
  Json line = replay_of(entry, "a stranger", "another");
  const auto with_claims = [&](std::size_t count) {
    std::string text = own;
    for (std::size_t i = 0; i < count; ++i) {
      line["by"] = fmt::format("stranger {}", i);
      text += canonical(line) + "\n";
    }
    write_file(file, text);
    const auto begun = std::clock();
    const std::string problems = fmt::format("{}", fmt::join(check(board.path).problems, "\n"));
    return std::pair(problems, static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC);
  };
  build(board.path);
  const double without = with_claims(0).second;
  const auto [problems, seconds] = with_claims(3000);
  EXPECT_SAYS(problems, "verifications.jsonl: expected at most 100 lines that no maintainer vouches for, got 3000");
  EXPECT_LT(seconds, without + 1) << "of the processor";
  const auto [of_some, seconds_of_some] = with_claims(100);
  EXPECT_EQ(of_some.find("verifications.jsonl"), std::string::npos) << of_some;
  EXPECT_LT(seconds_of_some, without + 1) << "of the processor";
  // Whoever verifies or vouches reads them all: a maintainer's line is not shut out.
  with_claims(200);
  EXPECT_EQ(vouch(board.path, entry.id(), "201").at("by"), "stranger 199");
}

TEST(Standings, SharedResamplesSayWhatOnePairsOwnResamplesSay) {
  const Setting setting = small_setting();
  for (const bool shared : {false, true}) {
    std::vector<std::vector<std::vector<std::vector<double>>>> rows(2);
    RandomStream random("rows");
    statistics::Samples differences, first;
    for (int scenario = 0; scenario < 3; ++scenario) {
      statistics::Outcomes of_first, of_both;
      for (auto& row : rows) row.emplace_back();
      for (int seed = 0; seed < 3; ++seed) {
        std::vector<double> a, b, difference;
        std::vector<std::string> scenes;
        for (int i = 0; i < 30; ++i) {
          a.push_back(random.uniform() < .4);
          b.push_back(a.back() > 0 || random.uniform() < .08);
          difference.push_back(b.back() - a.back());
          scenes.push_back(fmt::format("{}/{}/{}", scenario, shared ? 0 : seed, i));
        }
        rows[0].back().push_back(a);
        rows[1].back().push_back(b);
        of_first.add("", scenes, a);
        of_both.add("", scenes, difference);
      }
      first.push_back(of_first.sample());
      differences.push_back(of_both.sample());
    }
    const statistics::SharedResamples resamples(rows, shared, "name");
    const statistics::Change alone = statistics::paired_change(differences, "name");
    EXPECT_NEAR(resamples.p(0, 1), alone.p, .01);
    EXPECT_NEAR(resamples.p(1, 0), alone.p, .01);
    const statistics::Interval interval = statistics::success_interval(first, "name");
    EXPECT_NEAR(resamples.interval(0).low, interval.low, .01);
    EXPECT_NEAR(resamples.interval(0).high, interval.high, .01);
  }
}

TEST(Standings, AHugeDifferenceBearsTheCorrectionForManyEntries) {
  using Scenario = std::vector<std::vector<double>>;  // of each policy and scene
  const auto row = [](int successes) {
    Scenario policies(3, std::vector<double>(40));
    for (auto& scenes : policies) std::fill_n(scenes.begin(), successes, 1.);
    return std::vector<Scenario>(3, policies);
  };
  const statistics::SharedResamples resamples({row(0), row(8), row(8)}, false, "name");
  EXPECT_LT(resamples.p(0, 1), .05 / 100000);
  EXPECT_GT(resamples.p(0, 1), 0);
  EXPECT_LT(resamples.p(1, 0), .05 / 100000);
  EXPECT_GT(resamples.p(1, 2), .9);
}

TEST(Standings, TiesShareARankAndOnlyASignificantlyBetterEntryComesBefore) {
  const Setting setting = small_setting();
  const std::vector<Entry> entries{replayed_entry(setting, "a", .8), replayed_entry(setting, "b", .8),
                                   replayed_entry(setting, "c", .3), replayed_entry(setting, "oracle", 1, "reference"),
                                   replayed_entry(setting, "random_object", .5, "reference")};
  std::vector<const Entry*> table;
  for (const Entry& entry : entries) table.push_back(&entry);
  const std::vector<Standing> all = standings(table);
  ASSERT_EQ(all.size(), 5u);
  const auto by = [&](std::size_t i) { return all[i].entry->about.at("by").get<std::string>(); };
  EXPECT_EQ(by(0), "oracle") << "reference rows stand among the others, by score";
  EXPECT_EQ(by(3), "random_object");
  for (const std::size_t reference : {0, 3}) EXPECT_FALSE(all[reference].rank) << "a reference row has no rank";
  EXPECT_EQ(all[1].rank, 1);
  EXPECT_EQ(all[2].rank, 1);
  EXPECT_EQ(all[4].rank, 3);
  EXPECT_EQ(by(4), "c");
  for (const Standing& s : all) EXPECT_EQ(s.below_random, &s == &all[4]) << s.entry->about.at("by");
  for (const Standing& s : all) {
    EXPECT_LE(s.interval.low, s.score);
    EXPECT_GE(s.interval.high, s.score);
  }
  EXPECT_DOUBLE_EQ(*all[1].precision, .5);
}

TEST(Standings, EachRankingRanksItsOwnRowsAndAnswersOnlyMethodsOnFrozenAnswers) {
  const Setting setting = small_setting();
  std::vector<Entry> entries{replayed_entry(setting, "a", .8), replayed_entry(setting, "b", .3),
                             replayed_entry(setting, "c", .5)};
  entries[0].identity.row.options["policy"] = "heat_map";
  entries[0].identity.row.id = "human";
  entries[1].identity.row.id = "factorial";
  entries[1].identity.row.options["policy"] = "heat_map";
  entries[1].identity.row.options["input"] = "object_mask";
  entries[2].identity.row.options["policy"] = "regression";
  std::vector<const Entry*> table;
  for (const Entry& entry : entries) table.push_back(&entry);
  EXPECT_EQ(standings(table)[1].rank, 2) << "any policy";
  const std::vector<Standing> papers = standings(table, {}, Ranking::papers_network);
  ASSERT_EQ(papers.size(), 1u) << "the only one with the paper's network";
  EXPECT_EQ(papers[0].rank, 1);
  const std::vector<Standing> all = standings(table, {Track::abstraction, {"test"}}, Ranking::answers_only);
  for (const Standing& s : all) EXPECT_FALSE(s.rank);
  EXPECT_NEAR(*all[0].gap_closed, 1, 1e-12);
  EXPECT_NEAR(*all[2].gap_closed, 0, 1e-12);
  EXPECT_NEAR(*all[1].gap_closed, (*all[1].in_track - *all[2].in_track) / (*all[0].in_track - *all[2].in_track), 1e-12);
  EXPECT_FALSE(standings(table).front().gap_closed);
  // Methods that share frozen answers are ranked among each other, and those that select nothing.
  const auto selects = [](Entry& entry, const char* provenance) {
    for (const auto& scenario : entry.phi.items())
      for (Json& command : scenario.value()[0]) command["selection"]["provenance"] = provenance;
  };
  for (Entry& entry : entries) selects(entry, "recorded"), entry.identity.answers = RecordedAnswers{"claude_track"};
  entries[1].identity.answers = RecordedAnswers{};
  const Track frozen{Track::abstraction, {"test"}, "claude_track"};
  std::map<std::string, std::string> why;
  const auto tell = [&] {
    for (const Standing& s : standings(table, frozen, Ranking::answers_only))
      why[s.entry->identity.row.id] = s.rank ? std::to_string(*s.rank) : s.not_ranked;
    return why;
  };
  EXPECT_EQ(tell()["factorial"], "other answers than the frozen ones");
  EXPECT_EQ(tell()["human"], "1");
  selects(entries[1], "none");
  EXPECT_EQ(tell()["factorial"], "3");
  selects(entries[1], "rule");
  EXPECT_EQ(tell()["factorial"], "other answers than the frozen ones") << "a rule of its own";
  EXPECT_NE(words_of(Ranking::answers_only, &frozen).find("share one frozen file of answers,"), std::string::npos);
  const Track open_answers{Track::abstraction, {"test"}};
  EXPECT_NE(words_of(Ranking::answers_only, &open_answers).find("no row has a rank"), std::string::npos);
  EXPECT_EQ(rankings_of({}), (std::vector{Ranking::any_policy, Ranking::papers_network}));
  EXPECT_EQ(rankings_of({Track::open, {}}), std::vector{Ranking::any_policy});
  EXPECT_EQ(rankings_of({Track::abstraction, {"test"}}), std::vector{Ranking::answers_only});
}

// B succeeds where A does, but for one scene of each arm; C loses as many and one more, in other scenes than A, so that
// its difference is less sure.
TEST(Standings, ARowWithMoreSuccessHasNoGreaterRankAndSuccessAloneOrdersRows) {
  const Setting setting = small_setting();
  Entry a = replayed_entry(setting, "a", .6), b = a, c = a;
  b.identity.row.id = "method_of_b";
  c.identity.row.id = "method_of_c";
  const auto lose_one = [](std::string& letters) { letters[letters.find('.')] = 'a'; };
  for (Entry* entry : {&b, &c}) {
    for (PlayedCell& cell : entry->cells)
      for (auto& [arm, letters] : cell.outcomes) {
        if (entry == &c) std::reverse(letters.begin(), letters.end());
        lose_one(letters);
      }
    if (entry == &c) lose_one(c.cells[0].outcomes["test"]);
    entry->verifications = Json::array();
    add_vouched(*entry, replay_of(*entry, "b", "a processor"));
  }
  Entry truth = replayed_entry(setting, "human", .9);
  truth.identity.row.asks = "truth";
  const std::vector<Standing> all = standings({&c, &truth, &b, &a});
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0].entry, &truth) << "an upper bound stands where its success puts it";
  EXPECT_FALSE(all[0].rank);
  EXPECT_EQ(all[1].entry, &a);
  EXPECT_EQ(all[2].entry, &b);
  EXPECT_EQ(all[1].rank, 1);
  EXPECT_EQ(all[2].rank, 2);
  EXPECT_EQ(standings({&a, &c})[1].rank, 1) << "its scenes do not show that it is worse than A";
  EXPECT_EQ(all[3].entry, &c);
  EXPECT_EQ(all[3].rank, 2) << "a rank never decreases downwards";
}

// Success 1 in the control and at level 1, 0.5 at 2, 0 at 3 and 4, whatever the axis; nowhere else.
Entry perturbed_entry(const Setting& setting, const std::string& by) {
  Entry entry = replayed_entry(setting, by, 1);
  for (PlayedCell& cell : entry.cells) {
    cell.outcomes.clear();
    for (const std::string& arm : setting.scenario(cell.place.scenario).arms) {
      const bool all = arm == "control" || arm.back() == '1', half = arm.back() == '2';
      std::string letters(static_cast<std::size_t>(setting.episodes), 'a');
      const auto won = static_cast<std::ptrdiff_t>(arm.rfind("table", 0) == 0 ? 0
                                                   : all                      ? letters.size()
                                                   : half                     ? letters.size() / 2
                                                                              : 0);
      std::fill_n(letters.begin(), won, '.');
      cell.outcomes[arm] = letters;
    }
  }
  return entry;
}

TEST(Areas, AreTheTrapezoidsOfGradedAxesBesideTheControl) {
  Setting setting = small_setting();
  std::vector<std::string> arms{"control"};
  for (const char* axis : {"camera_shift", "sensor_noise", "table", "all"})
    for (int level = 1; level <= 4; ++level) arms.push_back(fmt::format("{}_{}", axis, level));
  EXPECT_TRUE(axes_of(setting).empty());
  EXPECT_TRUE(weights_of(setting.scenarios.front()).empty());
  for (Setting::Scenario& scenario : setting.scenarios) scenario.arms = arms;
  EXPECT_EQ(axes_of(setting), (std::vector<std::string>{"camera_shift", "sensor_noise"})) << "neither kinds nor all";
  const ArmWeights one = weights_of(setting.scenarios.front(), "camera_shift");
  EXPECT_EQ(one, (ArmWeights{{"control", .125},
                             {"camera_shift_1", .25},
                             {"camera_shift_2", .25},
                             {"camera_shift_3", .25},
                             {"camera_shift_4", .125}}));
  double sum = 0;
  for (const auto& weight : weights_of(setting.scenarios.front())) sum += weight.second;
  EXPECT_DOUBLE_EQ(sum, 1);
  const Entry entry = perturbed_entry(setting, "a");
  EXPECT_DOUBLE_EQ(control_success(entry), 1);
  EXPECT_NEAR(*relative_area(entry, "camera_shift"), .125 + .25 + .125, 1e-12);
  EXPECT_FALSE(relative_area(replayed_entry(setting, "b", 0), "camera_shift")) << "nothing of nothing";
  const Standing standing = standings({&entry}).front();
  EXPECT_NEAR(standing.score, .5, 1e-12);
  EXPECT_LE(standing.interval.low, .5);
  EXPECT_GE(standing.interval.high, .5);
  EXPECT_NEAR(*standing.areas.at("sensor_noise"), .5, 1e-12);
}

TEST(Tracks, AreReadAndRefuseAPresetInTwo) {
  TemporaryDirectory board;
  EXPECT_TRUE(read_tracks(board.path).empty());
  write_file(board.path / "tracks.json", R"({"abstraction": {"s-a": ["near"]}, "open": ["s-l"]})");
  const Tracks tracks = read_tracks(board.path);
  EXPECT_EQ(tracks.at("s-a").arms, std::vector<std::string>{"near"});
  EXPECT_EQ(tracks.at("s-l").kind, Track::open);
  EXPECT_FALSE(tracks.at("s-l").names_read);
  write_file(board.path / "tracks.json", R"({"open": ["s-l"], "names_read": ["s-l", "s-r"]})");
  EXPECT_TRUE(read_tracks(board.path).at("s-l").names_read) << "whatever its track";
  EXPECT_EQ(read_tracks(board.path).at("s-l").kind, Track::open);
  EXPECT_TRUE(read_tracks(board.path).at("s-r").names_read);
  write_file(board.path / "tracks.json", R"({"abstraction": {"s-l": []}, "open": ["s-l"]})");
  EXPECT_SAYS(message_of<InputError>([&] { read_tracks(board.path); }), "/open/0: expected each preset in one track");
  for (const auto& [frozen, complaint] :
       {std::pair(R"({"s-l": "claude"})", "/frozen/s-l: expected a preset of the abstraction track"),
        {R"({"s-a": "none"})", "/frozen/s-a: expected answers that are shipped"}}) {
    write_file(board.path / "tracks.json", fmt::format(R"({{"abstraction": {{"s-a": []}}, "frozen": {}}})", frozen));
    EXPECT_SAYS(message_of<InputError>([&] { read_tracks(board.path); }), complaint);
  }
  write_file(board.path / "tracks.json", R"({"abstraction": {"s-a": []}, "frozen": {"s-a": "claude_track"}})");
  EXPECT_EQ(read_tracks(board.path).at("s-a").answers, "claude_track");
  const Tracks other{{small_setting().name(), {Track::abstraction, {"hard", "near"}}}};
  EXPECT_SAYS(message_of<InputError>([&] { expect_arms(board.path, other, small_setting()); }),
              "tracks.json: /abstraction/q1-board/1: expected an arm that the preset has, got \"near\"");
}

TEST(Standings, NamesReadAreRankedWhereTheTrackSaysSo) {
  Entry read = replayed_entry(small_setting(), "a", .9), plain = replayed_entry(small_setting(), "b", .5);
  const std::string before = plain.id();
  EXPECT_FALSE(to_json(plain.identity).contains("names")) << "ids of entries of before stay";
  read.identity.conditions = {{"read", Reading::difference}, std::string(64, 'd')};
  EXPECT_NE(read.id(), before);
  const auto by_id = [&](const Track& track) {
    std::map<std::string, Standing> all;
    for (const Standing& one : standings({&read, &plain}, track)) all[one.entry->id()] = one;
    return all;
  };
  auto all = by_id({});
  EXPECT_EQ(all.at(read.id()).not_ranked, "names read from pictures");
  EXPECT_EQ(all.at(plain.id()).rank, 1) << "what has no rank influences none";
  Track track;
  track.names_read = true;
  all = by_id(track);
  EXPECT_EQ(all.at(read.id()).rank, 1);
  EXPECT_EQ(all.at(plain.id()).rank, 2);
}

TEST(Standings, RowsOfPersonsAreRankedOnceTheyMetOthers) {
  Entry asked = replayed_entry(small_setting(), "a", .9);
  asked.phi["heart"][0][0]["selection"]["provenance"] = "simulated_edit";
  for (const Json& line : asked.verifications) asked.vouched.insert(line_hash(line));
  const auto why = [&asked](const Track& track) { return standings({&asked}, track).front().not_ranked; };
  Track track{Track::abstraction, {"hard"}};
  EXPECT_EQ(why(track), "the truth stands in for people");
  track.persons = true;
  EXPECT_EQ(why(track), "not yet played with other persons");
  add_vouched(asked, fresh_of(asked, {}));
  EXPECT_EQ(why(track), "");
  asked.identity.answers = FileAnswers{std::string(64, 'd')};
  for (const Json& line : asked.verifications) asked.vouched.insert(line_hash(line));
  EXPECT_EQ(why(track), as_submitted);
  TemporaryDirectory board;
  write_file(board.path / "tracks.json", R"({"open": ["s-l"], "persons": ["s-l"]})");
  EXPECT_TRUE(read_tracks(board.path).at("s-l").persons);
}

TEST(Standings, EpisodesOfAFailedCellAreLost) {
  Entry entry = replayed_entry(small_setting(), "a", 1);
  entry.cells[0].failed = "signal 11";
  entry.cells[0].outcomes["test"] = std::string(40, failed_cell_letter);
  const Standing standing = standings({&entry}).front();
  EXPECT_EQ(standing.failed_cells, 1);
  EXPECT_NEAR(standing.score, 1 - .5 / 6, 1e-9);
  EXPECT_EQ(standing.episodes, 6 * 40 + 6 * 80);
}

TEST(Standings, AFailedCellMakesAnEntryNoCheaper) {
  Entry entry = replayed_entry(small_setting(), "a", 1);
  PlayedCell& cell = entry.cells[0];
  cell.failed = "signal 11";
  cell.outcomes["test"] = std::string(40, failed_cell_letter);
  cell.lm_queries = cell.learn_s = 0;  // as played_cell() writes it
  const Standing standing = standings({&entry}).front();
  EXPECT_NEAR(standing.lm_queries, 112, 1e-9);
  EXPECT_NEAR(standing.learn_s, 4, 1e-9);
  for (PlayedCell& each : entry.cells) each.failed = "signal 11";
  EXPECT_EQ(standings({&entry}).front().lm_queries, 0);
}

TEST(Standings, AnEntryThatNobodyReplayedHasNoInfluence) {
  std::vector<Entry> entries{replayed_entry(small_setting(), "a", .8), replayed_entry(small_setting(), "b", .3)};
  const auto rank = [&entries] {
    std::vector<const Entry*> table;
    for (const Entry& entry : entries) table.push_back(&entry);
    EXPECT_EQ(not_yet_replayed(table).size(), entries.size() - 2);
    return standings(table).back().rank;
  };
  EXPECT_EQ(rank(), 2);
  entries.push_back(made_entry(small_setting(), "c", 1));
  EXPECT_EQ(rank(), 2);
}

TEST(Standings, RowsThatAskForTheTruthOrTheNetworkAreNotRanked) {
  Entry entry = replayed_entry(small_setting(), "a", 1);
  entry.identity.row.asks = "truth";
  EXPECT_EQ(why_not_ranked(entry), "asks for the truth");
  entry.identity.row.asks = "";
  EXPECT_EQ(why_not_ranked(entry), "");
  entry.phi["heart"][0][0]["selection"]["provenance"] = "truth";
  EXPECT_EQ(why_not_ranked(entry), "the truth stands in for people");
}

TEST(Standings, AnswersAsSubmittedHaveNoRankAndInfluenceNone) {
  std::vector<Entry> entries{replayed_entry(small_setting(), "a", .9), replayed_entry(small_setting(), "b", .3)};
  const auto ranked = [&entries] { return standings({&entries[0], &entries[1]}, {Track::open}); };
  EXPECT_EQ(ranked()[1].rank, 2);
  entries[0].identity.answers = FileAnswers{std::string(64, 'd')};
  entries[0].vouched.clear();  // another identity: what was replayed is not this one
  EXPECT_EQ(why_not_ranked(entries[0]), "not yet replayed");
  for (const Json& line : entries[0].verifications) entries[0].vouched.insert(line_hash(line));
  const std::vector<Standing> all = ranked();
  EXPECT_EQ(all[1].rank, 1);
  EXPECT_EQ(all[1].entry, &entries[1]) << "by success";
  EXPECT_EQ(all[0].not_ranked, as_submitted);
  EXPECT_EQ(tier_and_marks(all[0]), "replayed; answers as submitted");
  entries[0].identity.row.kind = "reference";
  EXPECT_FALSE(entries[0].has_answers_as_submitted()) << "it asks nobody";
}

}  // namespace
}  // namespace lgabench::leaderboard
