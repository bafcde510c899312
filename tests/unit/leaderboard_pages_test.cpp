// A board's pages, and what `leaderboard check` finds: with 200 entries of q1's size, in seconds.
#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>

#include <lgabench/leaderboard/check.hpp>
#include <lgabench/leaderboard/pages.hpp>
#include <lgabench/leaderboard/suite_page.hpp>

#include "leaderboard_board.hpp"
#include "testing.hpp"

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
  EXPECT_SAYS(page.substr(more, page.find("</tr>", more) - more), "method_of_a, loss=squared");
  EXPECT_SILENT(index, "loss=squared");
  EXPECT_SAYS(index, "2 of 3 entries, the best of each method");
  for (const char* words :
       {"not yet replayed", "claimed by", "answers as submitted", "does not say that they are equal"})
    EXPECT_SAYS(index, words);
}

TEST(Board, SuitesComeInThePapersOrderAndThoseWithoutARankLast) {
  const TemporaryDirectory board;
  for (const char* suite : {"z_ranked", "a_diagnosis", "mobile", "q1"}) {
    Setting setting = small_setting();
    setting.suite = suite;
    write_replayed(board.path, made_entry(setting, "a", .5, *suite == 'a' ? "reference" : "method"));
  }
  build(board.path);
  const std::string page = read_file(board.path / "README.md");
  EXPECT_LT(page.find("## q1"), page.find("## mobile"));
  EXPECT_LT(page.find("## mobile"), page.find("## z_ranked"));
  EXPECT_LT(page.find("## z_ranked"), page.find("## a_diagnosis"));
}

TEST(Board, ARowBelowTheRandomObjectSaysSoAndTheIndexSaysWhatItLeavesOut) {
  const TemporaryDirectory board;
  const Setting setting = small_setting();
  write_replayed(board.path, made_entry(setting, "random_object", .5, "reference"));
  for (int i = 0; i < 12; ++i) write_replayed(board.path, made_entry(setting, fmt::format("m{}", i), i == 0 ? .2 : .8));
  build(board.path);
  EXPECT_SAYS(read_file(board.path / "index.html"),
              "10 of 12 entries, the best of each method; <a href=\"q1.html\">all of them</a>");
  EXPECT_SAYS(read_file(board.path / "index.html"), "random visible object") << "reference rows stay";
  const std::string page = read_file(board.path / "README.md"), suite = read_file(board.path / "q1.html");
  EXPECT_SILENT(page, "of 12 entries");
  EXPECT_SAYS(page, "]§ |");
  EXPECT_SAYS(page, "§ below the random visible object, which needs no demonstration.");
  EXPECT_SAYS(suite, "<span title=\"below the random visible object, which needs no demonstration\">§</span>");
  EXPECT_LT(suite.find("method_of_m1<"), suite.find("random visible object<"));
  EXPECT_LT(suite.find("random visible object<"), suite.find("method_of_m0<"));
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

TEST(Board, DocumentsHaveTheTablesOfReadme) {
  const TemporaryDirectory scratch;
  const fs::path board = scratch.path / "results/board", document = scratch.path / "docs/results.md";
  const std::string before = "# Results\n\nBy hand.\n\n<!-- board:q1-board -->\n", after = "<!-- /board -->\n\nMore.\n";
  const auto problems = [&] { return all(check(board, {"", false, {document}}).problems); };
  fs::create_directories(board / "entries");
  write_file(document, before + after);
  build(board, {document});
  EXPECT_EQ(read_file(document), before + "\nNo entry of q1-board yet.\n\n" + after);
  const Entry entry = made_entry(small_setting(), "a", .5);
  write_replayed(board, entry);
  build(board);
  EXPECT_SAYS(problems(), "results.md: not what lgabench leaderboard build makes");
  build(board, {document});
  EXPECT_EQ(problems(), "");
  const std::string text = read_file(document), readme = read_file(board / "README.md");
  EXPECT_EQ(text.find(before), 0u);
  EXPECT_SAYS(text, "\n\n" + after);
  std::string table = readme.substr(readme.find("| rank"), readme.find("\n## What the words") - readme.find("| rank"));
  EXPECT_SAYS(table, "](entries/");
  table.replace(table.find("](entries/"), 2, "](../results/board/");
  EXPECT_SAYS(text, table);
  build(board, {document});
  EXPECT_EQ(read_file(document), text) << "built twice";
  for (const std::string& broken : {before, after, fmt::format("{0}{0}{1}", before, after)}) {
    write_file(document, broken);
    EXPECT_SAYS(problems(), "results.md: expected <!-- ");
    EXPECT_THROW(build(board, {document}), InputError);
    EXPECT_EQ(read_file(document), broken);
  }
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
  for (const char* reference : {"src=\"http", "href=\"http", "url(http", "@import"})
    EXPECT_SILENT(page, reference) << "a page needs nothing from elsewhere";
}

}  // namespace
}  // namespace lgabench::leaderboard
