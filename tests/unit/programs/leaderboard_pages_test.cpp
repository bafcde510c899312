// A board's pages, and what `leaderboard check` finds: with 200 entries of q1's size, in seconds.
#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <regex>
#include <tuple>

#include <lgabench/core/rounding.hpp>
#include <lgabench/leaderboard/board_steps.hpp>
#include <lgabench/leaderboard/check.hpp>
#include <lgabench/leaderboard/overview.hpp>
#include <lgabench/leaderboard/pages.hpp>
#include <lgabench/leaderboard/scenes.hpp>
#include <lgabench/leaderboard/suite_page.hpp>

#include "../../schemas.hpp"
#include "../testing.hpp"
#include "leaderboard_board.hpp"

namespace lgabench::leaderboard {
namespace {

void git(const fs::path& board, const std::string& words) {
  const std::string command =
      "git -C " + board.string() + " -c user.name=a -c user.email=a@b.c " + words + " >/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

std::string all(const std::vector<std::string>& lines) { return fmt::format("{}", fmt::join(lines, "\n")); }

TEST(Board, WhatIsBuiltIsCurrentAndAnEditIsNot) {
  const TemporaryDirectory board;
  for (const char* name : {"a", "b"}) write_replayed(board.path, made_entry(small_setting(), name, .5));
  EXPECT_SAYS(all(check(board.path).problems), "not what lgabench leaderboard build makes");
  build(board.path);
  EXPECT_EQ(all(check(board.path).problems), "");
  EXPECT_SAYS(read_file(board.path / "README.md"), "(q1.html)");
  write_file(board.path / "leaderboard.csv", read_file(board.path / "leaderboard.csv") + "a line more\n");
  EXPECT_SAYS(all(check(board.path).problems), "leaderboard.csv: not what lgabench leaderboard build makes");
}

TEST(Board, AnswersThatNoEntryNamesAreFound) {
  const TemporaryDirectory board;
  Entry entry = made_entry(small_setting(), "a", .5);
  const std::string answers = "{}";
  entry.identity.answers_sha256 = sha256(answers);
  entry.identity.answers = FileAnswers{entry.identity.answers_sha256};
  write_replayed(board.path, entry);
  fs::create_directory(board.path / "answers");
  write_file(board.path / answers_file(entry.identity), answers);
  build(board.path);
  EXPECT_EQ(all(check(board.path).problems), "");
  write_file(board.path / "answers/other.json", answers);
  EXPECT_EQ(all(check(board.path).problems), "answers/other.json: no entry is based on it; remove it");
}

TEST(Board, WhatIsWrongIsSaidBeforeAnythingIsComputed) {
  const TemporaryDirectory board;
  write_replayed(board.path, made_entry(small_setting(), "a", .5));
  build(board.path);
  const auto complaint = [&](const std::vector<fs::path>& documents) {
    bool computed = false;
    const std::string said = message_of<InputError>([&] {
      build(board.path, documents, [&](const std::string& what, auto, auto, auto) { computed |= what == "computed"; });
    });
    EXPECT_FALSE(computed) << said;
    return said;
  };
  write_file(board.path / "document.txt", "<!-- board:q1-board -->");
  EXPECT_SAYS(complaint({board.path / "document.txt"}), "document.txt: expected <!-- /board --> after");
  write_file(board.path / "labels.json", "[]");
  EXPECT_SAYS(complaint({}), "labels.json: /: expected an object");
  fs::remove(board.path / "labels.json");
  const std::string scenes = R"({"0123456789abcdef": {"best": {"cell": "0123456789abcdef"}}})";
  write_file(board.path / "scenes.json", scenes);
  const std::string said =
      (board.path / "scenes.json").string() + ": /0123456789abcdef: expected the id of an entry of the board";
  EXPECT_EQ(complaint({}), said);
  EXPECT_SAYS(all(check(board.path).problems), said);
  // An entry that cannot be read is met later: scenes.json is looked at before any.
  write_file(board.path / entry_directories(board.path).front() / "entry.json", "{}");
  EXPECT_EQ(complaint({}), said);
}

TEST(Board, ReadingAndComputingAreToldOf) {
  const TemporaryDirectory board;
  for (const char* name : {"a", "b"}) write_replayed(board.path, made_entry(small_setting(), name, .5));
  std::vector<std::string> said;
  const OnProgress on_progress = [&](const char* what, std::size_t done, std::size_t of, const char* things) {
    said.push_back(fmt::format("{} {} of {} {}", what, done, of, things));
  };
  const std::vector<std::string> expected{"read 1 of 2 entries", "read 2 of 2 entries", "computed 1 of 1 tables"};
  build(board.path, {}, on_progress);
  EXPECT_EQ(said, expected);
  said.clear();
  CheckOptions options;
  options.on_progress = on_progress;
  EXPECT_EQ(all(check(board.path, options).problems), "");
  EXPECT_EQ(said, expected);
}

TEST(Board, ARequestHasNothingOfAnAddThatWasKilled) {
  const TemporaryDirectory repository;
  const fs::path board = repository.path / "board";
  write_replayed(board, made_entry(small_setting(), "a", .5));
  build(board);
  git(repository.path, "init -q && git -C " + repository.path.string() + " add -A");
  git(repository.path, "commit -q -m first");
  const fs::path before = fs::current_path();
  fs::current_path(repository.path);
  const auto problems = [&](const std::string& against) { return all(check(board, {against, false, {}}).problems); };
  EXPECT_EQ(problems("HEAD"), "");
  fs::create_directories(board / ".adding/x");
  write_file(board / ".adding/x/evil.json", "{}");
  fs::create_directory(board / "answers");
  write_file(board / "answers" / (sha256("{}") + ".json"), "{}");
  EXPECT_EQ(problems(""), "") << "as after an add that was killed";
  const std::string found = problems("HEAD");
  EXPECT_SAYS(found, ".adding: no file of a board");
  EXPECT_SAYS(found, sha256("{}") + ".json: no entry is based on it; remove it");
  fs::current_path(before);
}

TEST(Board, AnEntryMaySayItsSelectionsInEitherForm) {
  const TemporaryDirectory repository;
  const fs::path board = repository.path / "board";
  Entry entry = made_entry(small_setting(), "a", .5);
  write_replayed(board, entry);
  build(board);
  const fs::path file = board / entry.place() / "entry.json";
  write_file(file, long_entry_text(entry));  // as it was before 0.5
  git(repository.path, "init -q && git -C " + repository.path.string() + " add -A");
  git(repository.path, "commit -q -m first");
  const fs::path before = fs::current_path();
  fs::current_path(repository.path);
  EXPECT_EQ(build(board), std::vector<fs::path>{file});
  EXPECT_EQ(all(check(board, {"HEAD", false, {}}).problems), "");
  entry.phi["heart"][0][0]["utterance"] = "Bring me something else.";
  write_file(file, entry_text(entry));
  EXPECT_SAYS(all(check(board, {"HEAD", false, {}}).problems), "entry.json: /phi changed since HEAD");
  fs::current_path(before);
}

TEST(Board, ARowThatLacksSuitesStandsWhereItsSuccessPutsIt) {
  const TemporaryDirectory board;
  for (const auto& [suite, names] : {std::pair<std::string, std::string>{"q1", "abcd"}, {"q2", "abc"}, {"q3", "abe"}}) {
    Setting setting = small_setting();
    setting.suite = suite;
    const double hard = suite == "q2" ? .3 : 0;  // what all lose there
    for (const char name : names) {
      const double rate = std::map<char, double>{{'a', .8}, {'b', .35}, {'c', .95}, {'d', .6}, {'e', .05}}[name];
      write_replayed(board.path, made_entry(setting, std::string(1, name), std::max(.02, rate - hard)));
    }
  }
  build(board.path);
  const std::string page = read_file(board.path / "index.html");
  std::string order;
  std::map<std::size_t, char> places;
  for (const char name : std::string("abcde"))
    places[page.find(fmt::format("<th scope=row>method of {}", name))] = name;
  for (const auto& place : places) order += place.second;
  EXPECT_EQ(order, "cadbe") << "c and d are not in all suites, and none stands below what is worse";
}

TEST(Board, ARowSaysWhatTheKernelCouldNotConfine) {
  const TemporaryDirectory board;
  for (const auto& [name, confinement] : {std::pair("a", "Landlock 6, seccomp"),
                                          {"b", "Landlock 2 (without: truncation, TCP, signals), seccomp"},
                                          {"c", "no Landlock (files), seccomp"}}) {
    Entry entry = made_entry(small_setting(), name, .5);
    entry.evidence[0]["confinement"] = confinement;
    write_replayed(board.path, entry);
  }
  build(board.path);
  const std::string page = read_file(board.path / "README.md");
  EXPECT_SAYS(page, "replayed; partly confined");
  EXPECT_SAYS(page, "replayed; unconfined");
}

TEST(Board, AnOptionThatTellsRowsOfAMethodApartIsNamedAtAllThatHaveIt) {
  const TemporaryDirectory board;
  for (const auto& [name, loss] : {std::pair("a", "norm"), {"a", "squared"}, {"b", "norm"}, {"c", ""}}) {
    Entry entry = made_entry(small_setting(), name, .5);
    entry.identity.row.options["loss"] = loss;
    if (!*loss) entry.identity.row.options.erase("loss");
    write_replayed(board.path, entry);
  }
  build(board.path);
  const std::string page = read_file(board.path / "README.md");
  for (const char* row :
       {"| method_of_a, loss=norm |", "| method_of_a, loss=squared |", "| method_of_b, loss=norm |", "| method_of_c |"})
    EXPECT_SAYS(page, row);
}

TEST(Board, TheMaintainersLabelsStandBeforeTheAuthorsAndTheseBeforeNames) {
  const TemporaryDirectory board;
  for (const auto& [name, loss] : {std::pair("a", "norm"), {"a", "squared"}, {"b", "norm"}, {"c", "norm"}}) {
    Entry entry = made_entry(small_setting(), name, .5);
    entry.identity.row.options["loss"] = loss;
    if (*name != 'c') entry.about["label"] = std::string("Ours, ") + name;
    write_replayed(board.path, entry);
  }
  write_file(
      board.path / "labels.json",
      R"({"values": {"loss=squared": "squares"}, "rows": [{"id": "method_of_a", "options": {"loss": "norm"}, "label": "The first"}]})");
  build(board.path);
  const std::string page = read_file(board.path / "README.md");
  for (const char* row :
       {"| The first |", "| Ours, a, squares |", "| Ours, b, loss=norm |", "| method_of_c, loss=norm |"})
    EXPECT_SAYS(page, row);
  EXPECT_SAYS(read_file(board.path / "q1.html"), "<span title=\"method_of_a loss=norm\">The first</span>");
  write_file(board.path / "labels.json", R"({"names": {}})");
  EXPECT_SAYS(all(check(board.path).problems), "unknown member \"names\", expected one of: note, values, rows");
}

TEST(Board, APageBeginsWithTheBestRowOfEachMethod) {
  const TemporaryDirectory board;
  for (const auto& [name, loss, rate] : {std::tuple("a", "norm", .9), {"a", "squared", .2}, {"b", "norm", .5}}) {
    Entry entry = made_entry(small_setting(), name, rate);
    entry.identity.row.options["loss"] = loss;
    write_replayed(board.path, entry);
  }
  build(board.path);
  const std::string page = read_file(board.path / "q1.html"), index = read_file(board.path / "index.html");
  const std::size_t more = page.find("<tr class=more>");
  ASSERT_NE(more, page.npos);
  EXPECT_SAYS(page.substr(more, page.find("</tr>", more) - more), "method of a, loss squared");
  EXPECT_SAYS(index, "loss squared") << "the first page has every row of every suite";
  EXPECT_SAYS(page, "<dt>fresh</dt><dd>played on scenes that nobody knew") << "words are no code";
  for (const char* words :
       {"not yet replayed", "claimed by", "answers as submitted", "does not mean that they perform equally"})
    EXPECT_SAYS(index, words);
}

TEST(Board, APageBeginsWithTheBestTrainedRowOfAMethodToo) {
  const TemporaryDirectory board;
  for (const auto& [policy, rate] : {std::pair("centroid", .95), {"heat_map", .7}, {"regression", .3}}) {
    Entry entry = made_entry(small_setting(), "a", rate);
    entry.identity.row.options["policy"] = policy;
    write_replayed(board.path, entry);
  }
  build(board.path);
  const std::string page = read_file(board.path / "q1.html"), first = page.substr(0, page.find("</table>"));
  const std::regex row("<tr( class=more)?><th scope=row>[^\n]*policy=([a-z_]+)");
  std::map<std::string, bool> shown;
  for (std::sregex_iterator it(first.begin(), first.end(), row), end; it != end; ++it)
    shown[(*it)[2]] = (*it)[1].length() == 0;
  EXPECT_EQ(shown, (std::map<std::string, bool>{{"centroid", true}, {"heat_map", true}, {"regression", false}}));
}

TEST(Board, StepsAreOfRowsWithEqualOptionsAndAddUp) {
  Setting setting = small_setting();
  setting.suite = "clutter";
  for (Setting::Scenario& scenario : setting.scenarios) scenario.arms = {"near_4", "others_1"};
  setting.demonstrations = {5};
  std::vector<Entry> entries;
  const auto add = [&](const char* id, double rate, const Json& options) {
    entries.push_back(replayed_entry(setting, id, rate));
    entries.back().identity.row.id = entries.back().identity.row.name = id;
    entries.back().identity.row.options = options;
  };
  const auto steps = [&](const std::string& frozen = "", const std::string& rule = "") {
    std::vector<const Entry*> table;
    for (const Entry& entry : entries) table.push_back(&entry);
    Track track;
    track.answers = frozen;
    if (!rule.empty()) track.labels[5] = rule;
    return steps_of(standings(table), track);
  };
  add("gcbc_seg", .2, {{"policy", "heat_map"}});
  add("lga", .9, {{"policy", "heat_map"}, {"mask", "binary"}});
  add("lga", .1, {{"policy", "heat_map"}, {"mask", "binary"}, {"meaning", "structured"}});
  add("lga", .1, {{"policy", "centroid"}, {"mask", "binary"}});
  add("human", 1, {{"policy", "heat_map"}, {"mask", "binary"}});
  EXPECT_FALSE(steps());
  add("taken_features", .6, {{"policy", "heat_map"}, {"mask", "binary"}});
  const auto all = steps();
  ASSERT_TRUE(all);
  EXPECT_EQ(all->column.arm, "near_4");
  EXPECT_EQ(all->column.demonstrations, 5);
  ASSERT_EQ(all->played.size(), 4u);
  EXPECT_NEAR(all->played[0].success, .2, .1);
  EXPECT_NEAR(all->played[2].success, .9, .1);
  EXPECT_EQ(all->played[3].success, 1);
  EXPECT_EQ(all->best, all->played[2].success);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(all->steps[i].difference, all->played[i + 1].success - all->played[i].success, 1e-12);
    EXPECT_LT(all->steps[i].interval.low, all->steps[i].difference);
    EXPECT_GT(all->steps[i].interval.high, all->steps[i].difference);
  }
  for (const auto& [answers, rate] : {std::pair("claude_track", 1.), {"gpt4_released", .3}}) {
    add("lga", rate, {{"policy", "heat_map"}, {"mask", "binary"}});
    entries.back().identity.answers = RecordedAnswers{answers};
  }
  EXPECT_EQ(steps("claude_track")->played[2].success, 1) << "of rows with equal options that with the frozen answers";
  EXPECT_NEAR(steps("gpt4_released")->played[2].success, .3, .1);
  entries.resize(entries.size() - 2);

  // Labels are those of the rule that tracks.json names, if its row is there; the best row may be any.
  EXPECT_STREQ(steps("", "taken_names")->labels().stage->method, "taken_features");
  add("taken_names", .8, {{"policy", "heat_map"}, {"mask", "binary"}});
  EXPECT_STREQ(steps()->labels().stage->method, "taken_features");
  const auto named = steps("", "taken_names");
  EXPECT_STREQ(named->labels().stage->method, "taken_names");
  EXPECT_NEAR(named->read.difference, named->played[2].success - named->labels().success, 1e-12);
  add("lga_then_taken", .95, {{"policy", "heat_map"}, {"mask", "binary"}});
  add("stranger", .97, {});
  const auto both = steps("", "taken_names");
  ASSERT_EQ(both->played.size(), 5u);
  EXPECT_NEAR(both->both.difference, both->played[3].success - both->labels().success, 1e-12);
  EXPECT_GT(both->best, both->played[3].success);
  EXPECT_LT(both->best, 1);
}

TEST(Board, ACurveStandsForItsSuitesOtherPresets) {
  Setting one = small_setting();
  one.suite = "clutter";
  one.preset = "abstraction";
  for (Setting::Scenario& scenario : one.scenarios) scenario.arms = {"near_4"};
  one.demonstrations = {5};
  Setting curve = one, other = one;
  curve.preset = "curve";
  curve.demonstrations = {1, 5};
  other.suite = "fetch";
  for (Setting::Scenario& scenario : other.scenarios) scenario.arms = {"near"};
  Tracks tracks;
  for (const Setting& setting : {one, curve, other}) tracks[setting.name()].kind = Track::abstraction;
  std::vector<Entry> entries;
  for (const Setting& setting : {one, curve, other})
    for (const char* id : {"gcbc_seg", "taken_features", "lga", "human"}) {
      entries.push_back(replayed_entry(setting, id, setting.preset == "curve" ? .9 : .4));
      entries.back().identity.row.id = entries.back().identity.row.name = id;
      entries.back().identity.row.options = {{"policy", "heat_map"}};
    }
  const auto tables_of = [&](std::size_t i) {
    std::vector<const Entry*> table;
    for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) table.push_back(&entries[k]);
    return named_tables(table, {}, tracks);
  };
  std::vector<NamedTable> clutter = tables_of(0);
  for (NamedTable& table : tables_of(1)) clutter.push_back(std::move(table));
  const document::Grid grid = all_steps_grid({{"clutter", clutter}, {"fetch", tables_of(2)}});
  ASSERT_EQ(grid.rows.size(), 3u) << "the curve's two numbers, and the other suite's one";
  const auto text = [&](std::size_t row, std::size_t cell) { return grid.rows[row].cells[cell].text(); };
  for (const auto& [row, n, suite] : {std::tuple(0u, "1", "clutter"), {1u, "5", "clutter"}, {2u, "5", "fetch"}})
    EXPECT_EQ(text(row, 3), n) << suite;
  EXPECT_GT(std::stod(text(1, 4)), .8);
  EXPECT_LT(std::stod(text(2, 4)), .5);
  const Json tabs = suite_data(clutter, {}).at("tabs");
  EXPECT_EQ(tabs[0].at("title"), "Answers only, abstraction");
  EXPECT_EQ(tabs[1].at("title"), "Answers only, curve");
}

TEST(Board, QuestionsThatNobodyWasAskedAreNoNumber) {
  const TemporaryDirectory board;
  for (const auto& [name, source] : {std::pair("lists", "Claude (Anthropic, 2026)"), {"asked", "GPT-4 (released)"}}) {
    Entry entry = made_entry(small_setting(), name, .5);
    for (Json& scenario : entry.phi)
      scenario[0][0]["selection"].update({{"provenance", "recorded"}, {"source", source}});
    write_replayed(board.path, entry);
  }
  build(board.path);
  const std::string page = read_file(board.path / "q1.html");
  EXPECT_SAYS(page, ">not asked<");
  EXPECT_SAYS(page, ">112<");
}

TEST(Board, SuitesComeInTheOrderOfTracksAndThoseWithoutARankLast) {
  const TemporaryDirectory board;
  for (const char* suite : {"z_ranked", "a_diagnosis", "mobile", "q1"}) {
    Setting setting = small_setting();
    setting.suite = suite;
    write_replayed(board.path, made_entry(setting, "a", .5, *suite == 'a' ? "reference" : "method"));
  }
  write_file(board.path / tracks_file, R"({"suites": ["q1", "mobile"]})");
  build(board.path);
  const std::string page = read_file(board.path / "README.md");
  EXPECT_LT(page.find("(q1.html)"), page.find("(mobile.html)"));
  EXPECT_LT(page.find("(mobile.html)"), page.find("(z_ranked.html)"));
  EXPECT_LT(page.find("(z_ranked.html)"), page.find("(a_diagnosis.html)"));
}

TEST(Board, ARowBelowTheRandomObjectSaysSo) {
  const TemporaryDirectory board;
  const Setting setting = small_setting();
  write_replayed(board.path, made_entry(setting, "random_object", .5, "reference"));
  for (int i = 0; i < 12; ++i) write_replayed(board.path, made_entry(setting, fmt::format("m{}", i), i == 0 ? .2 : .8));
  build(board.path);
  const std::string page = read_file(board.path / "README.md"), suite = read_file(board.path / "q1.html");
  EXPECT_SAYS(page, "]§ |");
  EXPECT_SAYS(page, "§ below the random visible object, which needs no demonstration.");
  EXPECT_SAYS(suite, "<span title=\"below the random visible object, which needs no demonstration\">§</span>");
  EXPECT_LT(suite.find("method of m1<"), suite.find("Random visible object<"));
  EXPECT_LT(suite.find("Random visible object<"), suite.find("method of m0<"));
}

// q1 with a policy on the paper's network and one beside it.
void write_two_policies(const fs::path& board) {
  for (const auto& [name, policy, rate] : {std::tuple("a", "heat_map", .9), {"b", "regression", .5}}) {
    Entry entry = made_entry(small_setting(), name, rate);
    entry.identity.row.options["policy"] = policy;
    write_replayed(board, entry);
  }
}

TEST(Board, EachRankingIsATableOfItsOwn) {
  const TemporaryDirectory board;
  write_two_policies(board.path);
  write_file(board.path / "labels.json", R"({"values": {"policy=heat_map": "heat map"}})");
  build(board.path);
  EXPECT_SAYS(read_file(board.path / "README.md"), "| 1 | method_of_a | heat map |");
  const std::string csv = read_file(board.path / "leaderboard.csv"), page = read_file(board.path / "q1.html");
  EXPECT_SAYS(csv, ",demonstrations,ranking,rank,success,");
  EXPECT_SAYS(csv, ",all,any policy,1,");
  EXPECT_SAYS(csv, ",all,any policy,2,");
  EXPECT_SAYS(csv, ",all,paper's network,1,");
  EXPECT_SAYS(page, "<section id=\"table1\" aria-labelledby=\"table1-title\"><h2 id=\"table1-title\">Any policy</h2>");
  EXPECT_SAYS(page, "<h2 id=\"table2-title\">Paper's network</h2>");
  const std::string second = page.substr(page.find("<section id=\"table2\""));
  EXPECT_SILENT(second.substr(0, second.find("</section>")), "method of a");
}

TEST(Board, ThePreviewOfALinkSaysWhatThePageIs) {
  const TemporaryDirectory board;
  write_replayed(board.path, made_entry(small_setting(), "a", .5));
  build(board.path);
  for (const char* file : {"index.html", "q1.html"})
    for (const char* part :
         {"<link rel=\"icon\" href=\"data:image/svg+xml,", "<meta property=\"og:title\" content=\"lgabench",
          "property=\"og:description\" content=\""})
      EXPECT_SAYS(read_file(board.path / file), part) << file;
}

TEST(Board, ABuildNamesTheFilesThatItChanged) {
  const TemporaryDirectory board;
  write_replayed(board.path, made_entry(small_setting(), "a", .5));
  EXPECT_EQ(build(board.path).size(), 4u);
  EXPECT_EQ(build(board.path), std::vector<fs::path>());
  Setting other = small_setting();
  other.suite = "mobile";
  write_replayed(board.path, made_entry(other, "a", .5));
  std::vector<std::string> names;
  for (const fs::path& file : build(board.path)) names.push_back(file.filename());
  EXPECT_EQ(names, (std::vector<std::string>{"README.md", "index.html", "leaderboard.csv", "mobile.html"}));
}

// A board with one entry and its pictures; `bytes` of the best.
Entry write_scenes_of_one(const fs::path& board, const std::string& bytes = "a picture") {
  Entry entry = made_entry(small_setting(), "a", .5);
  write_replayed(board, entry);
  const PlayedCell& cell = entry.cells.front();
  Json scenes;
  for (const auto& [which, letter] : {std::pair("best", '.'), {"worst", 'a'}}) {
    scenes[entry.id()][which] = {{"cell", cell.key},
                                 {"arm", "test"},
                                 {"index", cell.outcomes.at("test").find(letter)},
                                 {"command", "Bring me the heart."},
                                 {"sha256", sha256(bytes)}};
    write_file(board / scene_picture(entry.id(), which), bytes);
  }
  write_file(board / scenes_file, scenes.dump());
  build(board);
  return entry;
}

TEST(Board, ScenesAreThoseThatTheMaintainersList) {
  const TemporaryDirectory board;
  const Entry entry = write_scenes_of_one(board.path);
  const auto problems = [&board] { return all(check(board.path).problems); };
  EXPECT_EQ(problems(), "");
  EXPECT_EQ(complaints("scenes", read_json(board.path / scenes_file)), std::vector<std::string>());
  EXPECT_SAYS(read_file(board.path / "q1.html"), "scenes/" + entry.id() + "-best.png");
  write_file(board.path / "scenes/other.png", "a picture");
  EXPECT_EQ(problems(), "scenes/other.png: no picture that scenes.json lists");
  fs::remove(board.path / "scenes/other.png");
  write_file(board.path / scene_picture(entry.id(), "best"), "another");
  EXPECT_EQ(problems(), "scenes/" + entry.id() + "-best.png: not the picture whose SHA-256 scenes.json has");
  fs::remove(board.path / scene_picture(entry.id(), "best"));
  EXPECT_EQ(problems(), "scenes/" + entry.id() + "-best.png: expected the picture that scenes.json lists");
  fs::create_symlink("/etc/hostname", board.path / scene_picture(entry.id(), "best"));
  EXPECT_SAYS(problems(), "-best.png: expected the picture that scenes.json lists");
  fs::remove(board.path / scenes_file);
  EXPECT_SAYS(problems(), "-worst.png: no picture that scenes.json lists");
}

TEST(Board, ScenesAreSmall) {
  const TemporaryDirectory board, large;
  write_scenes_of_one(board.path, std::string(most_picture_bytes, 'a'));
  EXPECT_EQ(all(check(board.path).problems), "");
  write_scenes_of_one(large.path, std::string(most_picture_bytes + 1, 'a'));
  EXPECT_SAYS(all(check(large.path).problems), "-best.png: expected at most 18000 bytes, got 18001");
  const std::string picture(most_picture_bytes, 'a');
  BoardScenes many;
  for (int i = 0; i < 600; ++i) {
    write_file(board.path / scene_picture(std::to_string(i), "best"), picture);
    many[std::to_string(i)]["best"].sha256 = sha256(picture);
  }
  EXPECT_SAYS(all(problems_of_scenes(board.path, many)),
              "scenes/: expected at most 10000000 bytes in all, got 10800000");
}

TEST(Board, SceneSaysNothingThatItsEntryDoesNot) {
  const TemporaryDirectory board;
  const Entry entry = write_scenes_of_one(board.path);
  const Json good = read_json(board.path / scenes_file);
  const Json::json_pointer best("/" + entry.id() + "/best");
  for (const auto& [member, value, problem] :
       {std::tuple("index", Json(entry.cells.front().outcomes.at("test").find('a')),
                   "expected an episode that succeeded"),
        {"index", Json(40), "/best/index: "},
        {"arm", Json("hard"), "expected an arm of the cell"},
        {"cell", Json("0123456789abcdef"), "expected a cell of the entry"},
        {"note", Json("more"), "unknown member \"note\""}}) {
    Json scenes = good;
    scenes[best][member] = value;
    write_file(board.path / scenes_file, scenes.dump());
    EXPECT_SAYS(all(check(board.path).problems), problem) << member;
  }
  write_file(board.path / scenes_file, Json{{"0123456789abcdef", good.at(entry.id())}}.dump());
  EXPECT_SAYS(all(check(board.path).problems), "expected the id of an entry of the board");
}

void replace_in(const fs::path& file, const std::string& old, const std::string& with) {
  std::string text = read_file(file);
  ASSERT_NE(text.find(old), text.npos) << old << " in " << file;
  write_file(file, text.replace(text.find(old), old.size(), with));
}

TEST(Board, APageIsCurrentIfWhatComesFromTheEntriesIs) {
  const TemporaryDirectory board;
  write_replayed(board.path, made_entry(small_setting(), "a", .5));
  build(board.path);
  const fs::path page = board.path / "q1.html";
  // Another version's style, dialog, scripts.
  replace_in(page, "</style>", "b { color: red }</style>");
  replace_in(page, ">Close</button>", ">Shut</button>");
  replace_in(page, "</body>", "<script>let more</script></body>");
  EXPECT_EQ(all(check(board.path).problems), "");
  replace_in(page, "method_of_a", "method_of_b");
  EXPECT_SAYS(all(check(board.path).problems), "q1.html: not what lgabench leaderboard build makes");
  build(board.path);
  replace_in(page, R"("successes":")", R"("successes":"A)");
  EXPECT_SAYS(all(check(board.path).problems), "q1.html: not what lgabench leaderboard build makes");
}

TEST(Board, DocumentsHaveSuccessByDemonstrations) {
  const TemporaryDirectory scratch;
  const fs::path board = scratch.path / "results/board", documents = scratch.path / "docs/results",
                 document = documents / "q1.md";
  const std::string before = "# Results\n\nBy hand.\n\n<!-- board:q1-board -->\n", after = "<!-- /board -->\n\nMore.\n";
  const auto problems = [&] { return all(check(board, {"", false, {documents}}).problems); };
  fs::create_directories(board / "entries");
  fs::create_directories(documents);
  write_file(document, before + after);
  write_file(documents / "engines.md", "# By hand alone\n");
  build(board, {documents});
  EXPECT_EQ(read_file(document), before + "\nNo entry of q1-board yet.\n\n" + after);
  const Entry entry = made_entry(small_setting(), "a", .5);
  write_replayed(board, entry);
  build(board);
  EXPECT_SAYS(problems(), "q1.md: not what lgabench leaderboard build makes");
  build(board, {documents});
  EXPECT_EQ(problems(), "");
  const std::string text = read_file(document);
  EXPECT_EQ(text.find(before), 0u);
  EXPECT_SAYS(text, "\n\n" + after);
  EXPECT_SAYS(text, "(../../results/board/q1.html)");
  const auto share = [&](const std::string& scenario, const std::string& arm, int n) {
    double won = 0, played = 0;
    for (const PlayedCell& cell : entry.cells)
      if (cell.place.scenario == scenario && cell.place.demonstrations == n)
        for (const char letter : cell.outcomes.at(arm)) won += is_success(letter), ++played;
    return won / played;
  };
  const double at_10 = (share("heart", "test", 10) + share("letter", "test", 10)) / 2,
               at_20 = (share("heart", "test", 20) + share("letter", "test", 20)) / 2;
  EXPECT_TRUE(std::regex_search(
      text, std::regex(fmt::format(R"(\| {} \[0[.0-9, ]+\] \| {} \[0[.0-9, ]+\] \|)", fixed(at_10), fixed(at_20)))))
      << text;
  EXPECT_EQ(text.find("every arm,"), text.npos) << "the board's page has them";
  build(board, {documents});
  EXPECT_EQ(read_file(document), text) << "built twice";
  for (const std::string& broken : {before, fmt::format("{0}{0}{1}", before, after)}) {
    write_file(document, broken);
    EXPECT_SAYS(problems(), "q1.md: expected <!-- ");
    EXPECT_THROW(build(board, {documents}), InputError);
    EXPECT_EQ(read_file(document), broken);
  }
}

TEST(Board, DocumentsHaveEveryArmWhereOneNumberOfDemonstrationsWasPlayed) {
  const TemporaryDirectory board;
  Setting setting = small_setting();
  setting.demonstrations = {20};
  write_replayed(board.path, made_entry(setting, "a", .5));
  const fs::path document = board.path / "q1.md";
  write_file(document, "<!-- board:q1-board -->\n<!-- /board -->\n");
  const auto made = made_files(board.path, read_entries(board.path), {document});
  EXPECT_TRUE(std::regex_search(
      made.at(document), std::regex(R"(\| test \| hard \|\n.*\n(.*\n)*.* \| 0\.\d\d \[0[.0-9, ]+\] \| 0\.\d\d \|\n)")))
      << made.at(document);
}

TEST(Board, RoundsAsReportsDo) {
  Standing standing;
  standing.score = .0625;  // a half of the third decimal
  standing.interval = {.0005, .4375};
  EXPECT_EQ(score_text(standing), "0.063 [0.001, 0.438]");
}

TEST(Board, EntriesOfOneTablePlayedTheSameScenes) {
  const TemporaryDirectory board;
  Entry other = made_entry(small_setting(), "b", .5);
  other.cells[1].scenes = std::string(64, '0');
  write_replayed(board.path, made_entry(small_setting(), "a", .5));
  write_replayed(board.path, other);
  EXPECT_SAYS(all(check(board.path).problems), "other test scenes than entries/method_of_a");
}

TEST(Board, AnOldOutcomeDoesNotChangeAndARecordStays) {
  const TemporaryDirectory repository;
  const fs::path board = repository.path / "board", before = fs::current_path();
  Entry entry = made_entry(small_setting(), "a", .5), gone = made_entry(small_setting(), "b", .5);
  for (const Entry& one : {entry, gone}) write_replayed(board, one);
  build(board);
  const auto problems_since = [&](const std::string& revision, bool maintainer) {
    fs::current_path(repository.path);
    const std::string problems = all(check("board", {revision, maintainer, {}}).problems);
    fs::current_path(before);
    return problems;
  };
  git(repository.path, "init -q");
  git(repository.path, "add .");
  git(repository.path, "commit -qm before");
  write_replayed(board, made_entry(small_setting(), "c", .5));  // a new one may come
  withdraw(board, gone.id(), "a mistake", "2026-01-01");        // and an old one be withdrawn
  build(board);
  EXPECT_SAYS(message_of<InputError>([&] { problems_since("HAED", true); }), "--against HAED: expected a revision");
  EXPECT_EQ(problems_since("HEAD", true), "");
  EXPECT_SAYS(problems_since("HEAD", false), "vouched.json: changed since HEAD: it is the maintainers' (--maintainer)");
  EXPECT_SAYS(problems_since("HEAD", false), "vouched_entries.json: changed since HEAD: it is the maintainers'");
  char& letter = entry.cells[3].outcomes["test"][0];
  letter = letter == '.' ? 'a' : '.';
  entry.about["by"] = "somebody else";
  write_entry(board, entry);
  fs::remove_all(board / gone.place());
  const std::string problems = problems_since("HEAD", true);
  EXPECT_SAYS(problems, "cells.jsonl: an outcome or a cell changed since HEAD");
  EXPECT_SAYS(problems, "/about changed since HEAD");
  EXPECT_SAYS(problems, "is gone (leaderboard withdraw keeps the record) since HEAD");
}

TEST(Board, AnEntryNamesWhoseCellsItsOwnTookThePlaceOf) {
  const TemporaryDirectory board;
  const Entry old = made_entry(small_setting(), "a", .5);
  const auto problems = [&](const std::function<void(Entry&)>& change) {
    Entry now = made_entry(small_setting(), "a", .6);
    for (std::size_t i = 0; i < now.cells.size(); ++i) now.cells[i].digest = sha256(old.cells[i].digest);
    now.supersedes.push_back({{"hash", old.hash()}, {"when", "2026-01-01"}, {"reason", "one order of additions"}});
    change(now);
    write_entry(board.path, now);
    EXPECT_EQ(complaints("entry", read_json(board.path / now.place() / "entry.json")), std::vector<std::string>());
    build(board.path);
    return all(check(board.path).problems);
  };
  const fs::path kept = board.path / superseded_place(old.id(), old.hash());
  const auto nothing = [](Entry&) {};
  write_entry(board.path, old);
  EXPECT_SAYS(problems(nothing), kept.lexically_relative(board.path).string() + ", whose place it took, is not there");
  write_file(kept / "entry.json", entry_text(old));
  write_file(kept / "cells.jsonl", cells_text(old));
  EXPECT_EQ(problems(nothing), "");
  EXPECT_SAYS(problems([](Entry& now) { now.supersedes.clear(); }), "no entry of this id names it in /supersedes");
  EXPECT_SAYS(problems([](Entry& now) { now.cells[1].scenes = std::string(64, '0'); }),
              "cell heart cells n=10 seed=1 has another with other test scenes in its place");
  EXPECT_SAYS(problems([](Entry& now) { now.about["by"] = "b"; }), "other authors or another score in its place");
}

// Generated once, with rates that differ from row to row.
TEST(Board, TwoHundredEntriesAreCheckedAsFastAsBuiltOnPagesOfThreeMegabytes) {
  const TemporaryDirectory scratch;
  const char* keep = std::getenv("LGABENCH_KEEP_BOARD");  // to look at its pages
  const fs::path board = keep ? fs::path(keep) : scratch.path;
  for (int i = 0; i < 197; ++i)
    write_replayed(board, made_entry(large_setting(), fmt::format("author_{}", i), .2 + .003 * i));
  for (const auto& [name, rate] : {std::pair("oracle", .99), {"random_object", .4}, {"constant_action", .2}})
    write_replayed(board, made_entry(large_setting(), name, rate, "reference"));
  const std::clock_t begin = std::clock();  // processor time: the machine may be busy
  build(board);
  const std::clock_t built = std::clock();
  const Checked checked = check(board);
  const auto share = static_cast<double>(std::clock() - built) / static_cast<double>(built - begin);
  EXPECT_EQ(all(checked.problems), "");
  EXPECT_EQ(checked.entries, 200u);
  EXPECT_LT(share, 2) << "a check builds the pages once, and reads each entry once more";
  for (const auto& file : fs::directory_iterator(board))
    if (file.is_regular_file()) {
      EXPECT_LT(fs::file_size(file.path()), 3'000'000u) << file.path();
    }
  for (const fs::path& entry : entry_directories(board))
    EXPECT_LT(fs::file_size(board / entry / "cells.jsonl") + fs::file_size(board / entry / "entry.json"), 300'000u);
  const std::string page = read_file(board / "q1.html");
  for (const char* reference : {"src=\"http", "rel=stylesheet", "url(http", "@import"})
    EXPECT_SILENT(page, reference) << "a page needs nothing from elsewhere";
}

}  // namespace
}  // namespace lgabench::leaderboard
